//! Eyes before a calibrated display: what the codes of its projectors show them is what the pictures show.

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use display_config::{CanonicalRaster, Display, EyeModel};
use glam::{DAffine3, DQuat, DVec2, DVec3, UVec3};
use lightloom_tests::calibrated::{self, LENS, MIRRORED_LENS};
use lightloom_tests::draw::{self, With};
use lightloom_tests::picture_difference::ImageDifference;
use lightloom_tests::scenes::{TestScene, frame, optics, placed};
use protocol::{DeviceChoice, ProjectorImage};
use renderer::output::{EyePlan, EyeView, Picture};
use renderer::present::Finisher;
use std::sync::Arc;

const SIZE: [u32; 2] = [240, 180];
const EYE: DVec3 = DVec3::new(0.03, 0.0, 1.2);
/// Two resamplings by a cubic and one of 8-bit codes stay above it.
const LEAST_DB: f64 = 38.0;
/// By which a mistake must lower it.
const CLEARLY_DB: f64 = 6.0;

fn shells(display: &Display) -> TestScene {
    let volume = ProceduralVolume::new("shells", UVec3::splat(64), 1e-3).unwrap();
    let source: Arc<dyn BrickSource> = Arc::new(volume);
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.15, 0.0), (0.35, 0.1), (0.5, 0.0), (0.6, 0.0), (0.75, 0.3), (1.0, 0.5)],
        &vec![(0.2, [0.9, 0.35, 0.1]), (0.6, [0.1, 0.6, 0.9]), (1.0, [1.0, 0.95, 0.8])],
    );
    // Large, and set off the middle: what is mirrored shows.
    let aside = DAffine3::from_translation(DVec3::new(0.05, 0.03, 0.0));
    let place = aside * placed(&*source, 1.6 * display.height_m, DQuat::from_rotation_y(0.4));
    TestScene { name: "shells", frame: frame(display, place, optics, None), source }
}

/// What the eye sees of some pictures, each found at the place of a screen point.
fn seen(
    display: &Display,
    images: &[ProjectorImage],
    place: impl Fn(usize, DVec2) -> Option<DVec2>,
) -> Picture {
    let model = EyeModel::new(display, EYE).unwrap();
    let raster = CanonicalRaster { width: 240, height: 180, ..display.canonical_raster() };
    let plan = EyePlan::new(raster, display.projectors.len(), |screen| model.weights(screen));
    let mut view = EyeView::new(&plan);
    for image in images {
        view.add_image(image, |screen| place(image.projector as usize, screen)).unwrap();
    }
    view.picture()
}

/// The light that the codes of a picture stand for.
fn undone(display: &Display, finished_as: &Display, image: &ProjectorImage) -> ProjectorImage {
    let projector = image.projector as usize;
    let codes = Finisher::new(&finished_as.projectors[projector]).codes(&image.rgba);
    let known = &display.projectors[projector];
    let share = |i: usize, count: u32| (i as f64 + 0.5) / f64::from(count);
    let pixel = |(i, codes): (usize, &[u8])| {
        let at =
            [share(i % image.width as usize, image.width), share(i / image.width as usize, image.height)];
        let light = |channel: usize| calibrated::undone(known, at, channel, codes[channel]) as f32;
        [light(0), light(1), light(2), 1.0]
    };
    let rgba = codes.chunks_exact(3).enumerate().flat_map(pixel).collect();
    ProjectorImage { rgba, ..*image }
}

#[test]
fn an_eye_sees_through_the_calibration_what_was_drawn() {
    let display = calibrated::display(SIZE);
    let scene = shells(&display);
    let everyone: Vec<u32> = (0..display.projectors.len() as u32).collect();
    let turn = draw::turn();
    let drawn =
        draw::draw(&display, &scene.frame, &scene.source, &everyone, With::device(DeviceChoice::Cpu)).images;
    drop(turn);
    let as_drawn = seen(&display, &drawn, |projector, screen| {
        display.projectors[projector].raster.pixel_from_screen(screen)
    });
    let place = |projector: usize, screen: DVec2| {
        let raster = &display.projectors[projector].raster;
        match projector {
            LENS => Some(calibrated::thrown_from(calibrated::lens, screen, raster.size())),
            MIRRORED_LENS => Some(calibrated::thrown_from(calibrated::mirrored_lens, screen, raster.size())),
            _ => raster.pixel_from_screen(screen),
        }
    };
    let psnr = |finished_as: &Display| {
        let images: Vec<_> = drawn.iter().map(|image| undone(&display, finished_as, image)).collect();
        let through = seen(&display, &images, place);
        ImageDifference::between(as_drawn.view().unwrap(), through.view().unwrap()).psnr_db
    };
    let right = psnr(&display);
    println!("an eye through the calibration: {right:.1} dB");
    assert!(right > LEAST_DB, "{right} dB");
    let spoiled = |spoil: &dyn Fn(&mut Display)| {
        let mut wrong = display.clone();
        spoil(&mut wrong);
        psnr(&wrong)
    };
    let canaries = [
        (
            "mirrored",
            spoiled(&|d| {
                d.projectors[LENS].finish.mesh = display.projectors[MIRRORED_LENS].finish.mesh.clone()
            }),
        ),
        ("no mesh", spoiled(&|d| d.projectors[MIRRORED_LENS].finish.mesh = None)),
        ("no blend", spoiled(&|d| d.projectors[calibrated::CORNERS].finish.blend = None)),
        ("no black level", spoiled(&|d| d.projectors[LENS].finish.black = None)),
    ];
    for (what, db) in canaries {
        assert!(db < right - CLEARLY_DB, "{what}: {db} dB, {right} dB where it is right");
    }
}
