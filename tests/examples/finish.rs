//! What the finish of calibrated projectors errs: pictures that are resampled through a mesh, by two filters, against rays
//! that are cast where each pixel falls.
//!
//! `cargo run --release -p lightloom-tests --example finish`. The mesh of a lens, upright and mirrored; a whole picture is
//! drawn at the projector's own size, as by the renderer, and read at each pixel's place.

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use display_config::{Display, Projector, Transfer};
use glam::{DQuat, DVec2, UVec3};
use lightloom_tests::calibrated::{self, LENS, MIRRORED_LENS};
use lightloom_tests::compare::lod_rule;
use lightloom_tests::draw::{self, With};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{TestScene, frame, optics, placed};
use protocol::{DeviceChoice, ProjectorImage};
use rayon::prelude::*;
use reference::{Filter, FinishTruth, Integrator, Reference};
use renderer::present::Finisher;
use std::sync::Arc;
use std::time::Instant;

/// Of the pixels along each axis, one in so many is compared.
const STRIDE: u32 = 3;
const SIZES: [[u32; 2]; 3] = [[160, 120], [320, 240], [640, 480]];

/// `procedural:shells@64` in the colours of the other studies, with crisp edges between its shells.
fn shells(display: &Display) -> Result<TestScene, String> {
    let volume =
        ProceduralVolume::new("shells", UVec3::splat(64), 1e-3).map_err(|error| error.to_string())?;
    let source: Arc<dyn BrickSource> = Arc::new(volume);
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.15, 0.0), (0.35, 0.03), (0.5, 0.0), (0.6, 0.0), (0.75, 0.15), (0.9, 0.02), (1.0, 0.3)],
        &vec![(0.2, [0.9, 0.35, 0.1]), (0.6, [0.1, 0.6, 0.9]), (1.0, [1.0, 0.95, 0.8])],
    );
    let place = placed(&*source, 1.6 * display.height_m, DQuat::from_rotation_y(0.4));
    Ok(TestScene { name: "shells", frame: frame(display, place, optics, None), source })
}

/// A pixel of a calibrated projector, and what a ray through the place where it falls sees.
struct Pixel {
    x: u32,
    y: u32,
    rgb: [f64; 3],
}

/// The truth, where the screen is: each pixel's own ray in f64, where its mesh or else its raster says that it falls.
fn truth(
    display: &Display,
    scene: &TestScene,
    projector: usize,
    is_meshed: bool,
) -> Result<Vec<Pixel>, String> {
    let rule = lod_rule(display, &scene.frame);
    let reference = Reference::new(Arc::clone(&scene.source), &scene.frame, &rule, Integrator::default());
    let reference = reference.map_err(|error| error.to_string())?;
    let law = display.beam_law(projector, scene.frame.observer_in_display, scene.frame.eta);
    let law = law.map_err(|error| error.to_string())?;
    let Projector { raster, finish, .. } = &display.projectors[projector];
    let mesh = finish.mesh.as_ref().ok_or("the projector has a mesh")?;
    let along = |n: u32| (STRIDE / 2..n).step_by(STRIDE as usize);
    let pixels: Vec<_> =
        along(raster.height).flat_map(|y| along(raster.width).map(move |x| (x, y))).collect();
    let traced = pixels.into_par_iter().map(|(x, y)| {
        let share = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / raster.size();
        let screen = if is_meshed { mesh.screen(share) } else { raster.pixel_on_screen(x, y) };
        if !raster.covers(screen) {
            return Ok(None);
        }
        let ray = law.ray(screen);
        let seen = reference.radiance(ray.origin_in_display, ray.direction_in_display);
        let seen = seen.map_err(|error| error.to_string())?;
        Ok(Some(Pixel { x, y, rgb: seen.rgb.to_array() }))
    });
    Ok(traced.collect::<Result<Vec<_>, String>>()?.into_iter().flatten().collect())
}

/// The errors of colours, in units of 1/255: root mean square, what 99.9 % stay within, and the largest.
fn errors(truth: &[Pixel], found: impl Fn(&Pixel) -> [f64; 3]) -> String {
    let apart = truth.iter().flat_map(|pixel| {
        let found = found(pixel);
        (0..3).map(move |c| 255.0 * (found[c] - pixel.rgb[c]).abs())
    });
    let mut apart: Vec<f64> = apart.collect();
    apart.sort_by(f64::total_cmp);
    let rms = (apart.iter().map(|error| error * error).sum::<f64>() / apart.len() as f64).sqrt();
    let [most, largest] = [apart[apart.len() * 999 / 1000], apart[apart.len() - 1]];
    format!("{rms:.3} / {most:.2} / {largest:.1}")
}

/// The errors of a picture that is resampled.
fn resampled(projector: &Projector, image: &ProjectorImage, truth: &[Pixel], filter: Filter) -> String {
    let finished = FinishTruth::new(projector, &image.rgba, filter);
    errors(truth, |pixel| finished.warped(pixel.x, pixel.y).unwrap_or_default())
}

/// The errors of the codes that are sent, without any other stage: those of rounding to 8 bits included.
fn sent(projector: &Projector, image: &ProjectorImage, truth: &[Pixel]) -> String {
    let mut projector = projector.clone();
    (projector.finish.black, projector.finish.blend) = (None, None);
    (projector.finish.transfer, projector.finish.is_dithered) = (Transfer::Gamma(1.0), false);
    let codes = Finisher::new(&projector).codes(&image.rgba);
    errors(truth, |pixel| {
        let at = 3 * (pixel.y * image.width + pixel.x) as usize;
        std::array::from_fn(|c| f64::from(codes[at + c]) / 255.0)
    })
}

fn main() -> Result<(), String> {
    let mut results = Results::new(Program::Study("finish"), "finish", "resampling");
    results.line("| projector | pixels | picture itself | bilinear | cubic | cubic, 8-bit linear codes | codes, ms | tables, ms |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for size in SIZES {
        let display = calibrated::display(size);
        let scene = shells(&display)?;
        for (name, projector) in [("lens", LENS), ("mirrored lens", MIRRORED_LENS)] {
            let with = With::device(DeviceChoice::Cpu);
            let image =
                draw::draw(&display, &scene.frame, &scene.source, &[projector as u32], with).images.remove(0);
            let as_drawn = truth(&display, &scene, projector, false)?;
            let truth = truth(&display, &scene, projector, true)?;
            let known = &display.projectors[projector];
            let by = |filter| resampled(known, &image, &truth, filter);
            let itself = errors(&as_drawn, |pixel| {
                let at = 4 * (pixel.y * image.width + pixel.x) as usize;
                std::array::from_fn(|c| f64::from(image.rgba[at + c]))
            });
            let (tables, codes) = timed(known, &image);
            let (bilinear, cubic) = (by(Filter::Bilinear), by(Filter::Cubic));
            let sent = sent(known, &image, &truth);
            let [width, height] = size;
            results.line(format!(
                "| {name} | {width} × {height} | {itself} | {bilinear} | {cubic} | {sent} | {codes:.1} | {tables:.1} |"
            ));
        }
    }
    results.finish()
}

/// Milliseconds that the tables of a projector take, and then the codes of a picture: the least of five.
fn timed(projector: &Projector, image: &ProjectorImage) -> (f64, f64) {
    let least = |work: &mut dyn FnMut()| {
        let once = |_| {
            let started = Instant::now();
            work();
            1e3 * started.elapsed().as_secs_f64()
        };
        (0..5).map(once).fold(f64::INFINITY, f64::min)
    };
    let finisher = Finisher::new(projector);
    let tables = least(&mut || drop(Finisher::new(projector)));
    (tables, least(&mut || drop(finisher.codes(&image.rgba))))
}
