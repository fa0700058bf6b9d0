//! What a walking eye sees of a display whose pictures are reconstructed, or late.

use super::{FRAMES, MOTIONS, RESTING, Shown, shown_of_full, shown_of_sub_frames, truths};
use display_config::{Display, EyeModel};
use glam::DVec3;
use lightloom_tests::compare::errors_between;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::TestScene;
use nv_flip::{FlipImageRgb8, FlipPool, flip};
use protocol::ProjectorImage;
use renderer::output::{EyePlan, EyeView, Picture, PictureRef, write_png};
use renderer::present::{Finisher, Thresholds};
use std::path::Path;

/// From side to side within the zone from which desk8 is seen whole, ±0.132 m: half a metre a second.
const WALK_M: (f64, f64) = (-0.12, 0.13);

/// Where the eye is in an instant of motion.
fn place(display: &Display, instant: usize) -> DVec3 {
    let share = instant.saturating_sub(RESTING) as f64 / (FRAMES - 1) as f64;
    DVec3 { x: WALK_M.0 + share * (WALK_M.1 - WALK_M.0), ..display.observer_in_display }
}

fn seen(display: &Display, images: &[ProjectorImage], eye: DVec3) -> Result<Picture, String> {
    let model = EyeModel::new(display, eye).map_err(|error| error.to_string())?;
    let plan = EyePlan::new(display.canonical_raster(), images.len(), |screen| model.weights(screen));
    let mut view = EyeView::new(&plan);
    for image in images {
        let inverse = display.projectors[image.projector as usize].raster.inverse();
        let inverse = inverse.ok_or("a raster of the display is singular")?;
        view.add_image(image, |screen| inverse.pixel(screen)).map_err(|error| error.to_string())?;
    }
    Ok(view.picture())
}

/// Pixels of the screen's middle that a degree of the eye's sight takes.
fn pixels_per_degree(display: &Display) -> f32 {
    let raster = display.canonical_raster();
    let degree_m = display.observer_in_display.z * 1.0_f64.to_radians().tan();
    (degree_m / (raster.size_m.x / f64::from(raster.width))) as f32
}

fn image(picture: &Picture) -> ProjectorImage {
    let Picture { width, height, rgba } = picture.clone();
    ProjectorImage { projector: 0, width, height, rgba }
}

/// The mean FLIP difference of two pictures.
fn mean_flip(display: &Display, picture: &Picture, truth: &Picture) -> f32 {
    let plain = Finisher::new(&display.projectors[0]);
    let coded = |picture: &Picture| {
        FlipImageRgb8::with_data(picture.width, picture.height, &plain.codes(&picture.rgba))
    };
    FlipPool::from_image(&flip(coded(truth), coded(picture), pixels_per_degree(display))).mean()
}

/// What a contender errs over all instants of motion.
struct Judged {
    /// Linear colour.
    rms: f64,
    flip: f64,
    /// The instant with the largest FLIP.
    worst: usize,
}

fn judge(display: &Display, shown: &Shown, truths: &Shown) -> Result<Judged, String> {
    let (mut squares, mut flips, mut worst) = (0.0, 0.0, (RESTING, 0.0));
    for instant in RESTING..truths.len() {
        let eye = place(display, instant);
        let (picture, truth) = (seen(display, &shown[instant], eye)?, seen(display, &truths[instant], eye)?);
        let rms = errors_between(&[image(&picture)], &[image(&truth)]).rms;
        let flip = mean_flip(display, &picture, &truth);
        squares += rms * rms;
        flips += f64::from(flip);
        if flip > worst.1 {
            worst = (instant, flip);
        }
    }
    let count = (truths.len() - RESTING) as f64;
    Ok(Judged { rms: (squares / count).sqrt(), flip: flips / count, worst: worst.0 })
}

/// The table of what eyes see, and the worst instants as pictures where a folder is given.
pub fn compare(display: &Display, scenes: &[TestScene], worst: Option<&Path>) -> Result<(), String> {
    let mut results = Results::new(Program::Study("reconstruction"), "reconstruction", "eyes");
    results.line("| scene and motion | full at 15 a second: RMS | quincunx at 60: RMS | ratio | full: FLIP | quincunx: FLIP | ratio |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    let everyone: Vec<u32> = (0..display.projectors.len() as u32).collect();
    let (mut sum, mut count) = ([0.0, 0.0], 0.0);
    for (scene, motion) in scenes.iter().flat_map(|scene| MOTIONS.iter().map(move |motion| (scene, motion))) {
        let truths = truths(display, scene, motion, &everyone);
        let full = judge(display, &shown_of_full(&truths, 4), &truths)?;
        let shown = shown_of_sub_frames(&truths, Thresholds::default(), false);
        let quincunx = judge(display, &shown, &truths)?;
        let ratios = [full.rms / quincunx.rms, full.flip / quincunx.flip];
        results.line(format!(
            "| {}, {} | {:.2} | {:.2} | {:.2} | {:.4} | {:.4} | {:.2} |",
            scene.name,
            motion.0,
            255.0 * full.rms,
            255.0 * quincunx.rms,
            ratios[0],
            full.flip,
            quincunx.flip,
            ratios[1]
        ));
        sum.iter_mut().zip(ratios).for_each(|(sum, ratio)| *sum += ratio.ln());
        count += 1.0;
        if let Some(folder) = worst {
            let name = format!("eye-{}-{}", scene.name, motion.0).replace([' ', ',', '°', '/'], "-");
            let eye = place(display, quincunx.worst);
            for (what, pictures) in [("shown", &shown), ("truth", &truths)] {
                let picture = seen(display, &pictures[quincunx.worst], eye)?;
                let file = folder.join(format!("{name}-{what}.png"));
                let view: PictureRef = picture.view().map_err(|error| error.to_string())?;
                write_png(&file, view).map_err(|error| error.to_string())?;
            }
        }
    }
    let [rms, flip] = sum.map(|sum: f64| (sum / count).exp());
    results.line(format!("| *geometric mean* | | | {rms:.2} | | | {flip:.2} |"));
    results.finish()
}
