//! What an eye sees of a display at η = 1, against the ordinary perspective picture from there by the reference.
//!
//! What is left between the two is angular sampling. No eye is on one projector's beams for all of the screen: at η = 1
//! a projector's rays cross the viewer's line at Ox = Ex (1 − k) + k Sx, so each screen column has its own two projectors
//! next to the eye, and the eye sees their mix. Φ of holo72 is narrower than the spacing of its beams, so the lobes are as
//! wide as that spacing. Two beams that meet at a screen point are up to |z| · spacing apart at depth z: that is the
//! blur, nothing at the screen and, for a smooth object, an error that grows with the square of |z|.

use bricks::BrickSource;
use display_config::{Display, EyeModel};
use glam::{DAffine3, DVec2, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::lod_rule;
use lightloom_tests::draw::{self, With};
use lightloom_tests::made_once::MadeOnce;
use lightloom_tests::picture_difference::ImageDifference;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, TestScene, frame, optics};
use protocol::{DeviceChoice, FrameState, ProjectorImage};
use rayon::prelude::*;
use reference::{Integrator, Reference};
use renderer::output::{EyePlan, EyeView, Picture};
use std::sync::Arc;

/// x of the eyes, metres, at the viewer's height and distance: holo72's zone is ±0.6 m there.
const EYES: [f64; 5] = [-0.45, -0.2, 0.0, 0.0253, 0.4];
/// A shift of an eye that must show.
const SHIFT_M: f64 = 0.2;
/// What the finest of the test scenes keeps: bone and skin of the cranium, up to 0.2 m off the screen.
const LEAST_DB: f64 = 40.0;
/// By which its PSNR must fall.
const CLEARLY_DB: f64 = 6.0;
/// What default quality promises of every projector's picture, RMS and largest; a mix of such pictures keeps it.
const PROMISE: (f64, f64) = (0.5 / 255.0, 4.0 / 255.0);

/// holo72 with pixels of a centimetre.
fn holo72_small() -> Display {
    Display::load("holo72").unwrap().with_rasters(160, 90)
}

/// A sheet of 2 mm at depth z, beyond the screen's edges, with a pattern of waves some 0.12 m long.
fn sheet(display: &Display, z_m: f64) -> TestScene {
    let wave = |p: DVec3| 0.5 + 0.25 * (p.x * 0.5).sin() + 0.2 * (p.y * 0.4 + p.x * 0.3).cos();
    let source: Arc<dyn BrickSource> =
        Arc::new(ClosureVolume::new(UVec3::new(280, 140, 2), (0.0, 1.0), wave));
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.0, 0.2), (1.0, 1.5)],
        &vec![(0.0, [0.1, 0.3, 1.0]), (1.0, [1.0, 0.8, 0.1])],
    );
    let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, z_m))
        * DAffine3::from_scale(DVec3::new(0.01, 0.01, 0.001))
        * DAffine3::from_translation(DVec3::new(-140.0, -70.0, -1.0));
    TestScene { name: "sheet", source, frame: frame(display, place, optics, None) }
}

fn pictures(display: &Display, scene: &TestScene) -> Vec<ProjectorImage> {
    let everyone: Vec<u32> = (0..display.projectors.len() as u32).collect();
    let with = With::device(DeviceChoice::Cpu);
    draw::drawn_once(display, &scene.frame, &scene.source, &everyone, with).images.clone()
}

fn eye_at(display: &Display, x: f64) -> DVec3 {
    DVec3 { x, ..display.observer_in_display }
}

/// What the eye sees of the display that shows `images`.
fn seen(display: &Display, images: &[ProjectorImage], eye: DVec3) -> Picture {
    let model = EyeModel::new(display, eye).unwrap();
    let plan = EyePlan::new(display.canonical_raster(), images.len(), |screen| model.weights(screen));
    let mut view = EyeView::new(&plan);
    for image in images {
        let inverse = display.projectors[image.projector as usize].raster.inverse().unwrap();
        view.add_image(image, |screen| inverse.pixel(screen)).unwrap();
    }
    view.picture()
}

/// A picture on the screen's raster, whose colour at a screen point is the reference's mean over rays with weights.
fn by_reference(
    display: &Display,
    scene: &TestScene,
    rays: impl Fn(DVec2) -> Vec<(DVec3, f64)> + Sync,
) -> Picture {
    let rule = lod_rule(display, &scene.frame);
    let reference =
        Reference::new(Arc::clone(&scene.source), &scene.frame, &rule, Integrator::default()).unwrap();
    let raster = display.canonical_raster();
    let rgba: Vec<[f32; 4]> = (0..raster.width * raster.height)
        .into_par_iter()
        .map(|index| {
            let screen = raster.point(index % raster.width, index / raster.width);
            let mut sum = [0.0; 4];
            for (origin, weight) in rays(screen) {
                let light = reference.radiance(origin, screen.extend(0.0) - origin).unwrap();
                let [r, g, b] = light.rgb.to_array();
                sum.iter_mut().zip([r, g, b, light.opacity]).for_each(|(sum, n)| *sum += weight * n);
            }
            sum.map(|n| n as f32)
        })
        .collect();
    Picture { width: raster.width, height: raster.height, rgba: rgba.into_flattened() }
}

/// The perspective picture from an eye.
fn direct(display: &Display, scene: &TestScene, eye: DVec3) -> Picture {
    let TestScene { frame, source, .. } = scene;
    // The volume is known by its address, which stays its own as long as it is kept here.
    static DIRECT: MadeOnce<(Arc<dyn BrickSource>, Picture)> = MadeOnce::new();
    let key = format!("{:p} {eye:?} {frame:?} {display:?}", Arc::as_ptr(source));
    let make = || (Arc::clone(source), by_reference(display, scene, |_| vec![(eye, 1.0)]));
    DIRECT.get(key, make).1.clone()
}

/// What an eye would see if every projector showed the truth.
fn ideal(display: &Display, scene: &TestScene, eye: DVec3) -> Picture {
    let FrameState { observer_in_display, eta, .. } = scene.frame;
    let model = EyeModel::new(display, eye).unwrap();
    by_reference(display, scene, |screen| {
        let of_projector = |(projector, weight): (usize, f64)| {
            (display.beam_law(projector, observer_in_display, eta).unwrap().origin(screen), weight)
        };
        model.weights(screen).into_iter().map(of_projector).collect()
    })
}

fn apart(a: &Picture, b: &Picture) -> ImageDifference {
    ImageDifference::between(a.view().unwrap(), b.view().unwrap())
}

fn row(name: &str, x: f64, difference: &ImageDifference) {
    let ImageDifference { rms, max, psnr_db, .. } = difference;
    println!(
        "{name:24} x = {x:7.4} m   {psnr_db:6.2} dB   RMS {:7.3}   max {:7.2} (of 255)",
        rms * 255.0,
        max * 255.0
    );
}

/// Prints the eyes' table, and gives what each is off by; every eye has its canary.
fn table(display: &Display, scene: &TestScene, name: &str) -> Vec<ImageDifference> {
    let images = pictures(display, scene);
    let eyes = EYES.iter().map(|&x| {
        let truth = direct(display, scene, eye_at(display, x));
        let right = apart(&seen(display, &images, eye_at(display, x)), &truth);
        let shifted = apart(&seen(display, &images, eye_at(display, x - SHIFT_M * x.signum())), &truth);
        row(name, x, &right);
        row("    an eye 0.2 m aside", x - SHIFT_M * x.signum(), &shifted);
        assert!(right.psnr_db > shifted.psnr_db + CLEARLY_DB, "{name}: a wrong place for an eye passes");
        right
    });
    eyes.collect()
}

/// The PSNR of each.
fn decibels(found: &[ImageDifference]) -> Vec<f64> {
    found.iter().map(|difference| difference.psnr_db).collect()
}

#[test]
fn an_eye_sees_the_perspective_picture_on_the_screen_and_a_blurred_one_off_it() {
    let _turn = draw::turn();
    let display = holo72_small();
    let mut before = vec![f64::INFINITY; EYES.len()];
    for z in [0.0, 0.05, 0.1, 0.2, 0.3] {
        let found = decibels(&table(&display, &sheet(&display, z), &format!("sheet at {z:.2} m")));
        let falls = found.iter().zip(&before).all(|(now, before)| now < before);
        assert!(falls, "z = {z} m: {found:?} dB, nearer to the screen {before:?} dB");
        before = found;
    }
}

#[test]
fn eyes_see_shells_and_the_cranium() {
    let _turn = draw::turn();
    let display = holo72_small();
    for scene in [Some(scenes::shells(&display)), scenes::cranium(&display)].into_iter().flatten() {
        let found = decibels(&table(&display, &scene, scene.name));
        assert!(found.iter().all(|&psnr| psnr > LEAST_DB), "{}: {found:?} dB", scene.name);
    }
}

#[test]
fn what_is_left_is_angular_sampling() {
    let _turn = draw::turn();
    let display = holo72_small();
    let Some(scene) = scenes::cranium(&display) else { return };
    let images = pictures(&display, &scene);
    for x in EYES {
        let eye = eye_at(&display, x);
        let seen = seen(&display, &images, eye);
        let of_devices = apart(&seen, &ideal(&display, &scene, eye));
        let of_beams = apart(&seen, &direct(&display, &scene, eye));
        row("by the device", x, &of_devices);
        row("with angular sampling", x, &of_beams);
        assert!(of_devices.rms < PROMISE.0 && of_devices.max < PROMISE.1);
        assert!(of_beams.rms > 2.0 * of_devices.rms, "the comparison does not tell the two apart");
    }
}

#[test]
fn on_a_beam_an_eye_sees_one_projector_and_no_blur() {
    let _turn = draw::turn();
    let display = holo72_small();
    let Some(scene) = scenes::cranium(&display) else { return };
    let images = pictures(&display, &scene);
    let raster = display.canonical_raster();
    let law = display.beam_law(40, display.observer_in_display, 1.0).unwrap();
    for column in [70u32, 80, 91] {
        let screen = raster.point(column, 45);
        let eye = eye_at(&display, law.origin(screen).x);
        let model = EyeModel::new(&display, eye).unwrap();
        let alone =
            |column: u32| model.weights(raster.point(column, 45)).iter().any(|&(_, w)| w > 1.0 - 1e-9);
        let columns: Vec<u32> = (0..raster.width).filter(|&column| alone(column)).collect();
        // One projector all over the screen, for no eye; but one column may be a beam's own.
        assert!(columns.contains(&column) && columns.len() < 10, "{columns:?}");
        let (seen, truth) = (seen(&display, &images, eye), direct(&display, &scene, eye));
        let worst = |column: u32| {
            let difference = |y: u32| {
                let at = 4 * (y * raster.width + column) as usize;
                (0..3)
                    .map(move |c| at + c)
                    .map(|i| f64::from(seen.rgba[i] - truth.rgba[i]).abs())
                    .fold(0.0, f64::max)
            };
            (0..raster.height).map(difference).fold(0.0, f64::max)
        };
        let beside = worst(column - 2).max(worst(column + 2));
        println!(
            "eye at {:.4} m: column {column} off by {:.3}, beside it {:.3} (of 255)",
            eye.x,
            255.0 * worst(column),
            255.0 * beside
        );
        assert!(worst(column) < PROMISE.1 && beside > PROMISE.1);
    }
}

/// Half an hour on two cores: `LIGHTLOOM_RESULTS=1 cargo test --release -p lightloom-tests --test accuracy -- eye:: --ignored`.
#[test]
#[ignore = "72 pictures of 800 × 600 for each scene"]
fn the_table_at_full_size() {
    let _turn = draw::turn();
    let display = Display::load("holo72").unwrap();
    let mut results = Results::new(Program::Tests("accuracy"), "accuracy", "eyes");
    results.line(format!("| scene | eyes at x, m | {} |", EYES.map(|x| x.to_string()).join(" | ")));
    results.line(format!("| --- | --- |{}", " ---: |".repeat(EYES.len())));
    let sheet = sheet(&display, 0.0);
    for scene in
        [Some(sheet), Some(scenes::shells(&display)), scenes::cranium(&display)].into_iter().flatten()
    {
        let found = table(&display, &scene, scene.name);
        for (what, cell) in [
            ("PSNR, dB", (|eye| format!("{:.1}", eye.psnr_db)) as fn(&ImageDifference) -> String),
            ("RMS / largest of 255", |eye| format!("{:.3} / {:.2}", 255.0 * eye.rms, 255.0 * eye.max)),
        ] {
            let cells: Vec<String> = found.iter().map(cell).collect();
            results.line(format!("| {} | {what} | {} |", scene.name, cells.join(" | ")));
        }
    }
    results.finish().unwrap();
}
