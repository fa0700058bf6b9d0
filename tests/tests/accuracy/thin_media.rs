//! Media so thin that 1 − exp(−x) would be lost in rounding: right in parts of what there is to see.

use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, UVec3};
use lightloom_tests::closure_volume::{ClosureVolume, bumps};
use lightloom_tests::compare::{Errors, Limits, TruePixel, errors_of, truth};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{frame, optics, placed};
use optics::Light;
use protocol::{FrameState, ProjectorImage};
use std::sync::Arc;

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// In parts of the largest opacity, as default quality keeps elsewhere. The tolerance of a step is absolute: here no step is
/// cut and all are a voxel long, on bumps ten voxels wide; where a knee of the transfer function falls between two samples
/// that shows.
const KEPT: Limits = Limits::of_255(0.15, 2.0, 4.0);
/// What an error of the third digit looks like: it must not pass.
const THOUSANDTHS: f64 = 1.02;

fn scene(display: &Display, source: &Arc<dyn BrickSource>, per_voxel: f64) -> FrameState {
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.3, 0.0), (0.9, per_voxel)],
        &vec![(0.0, [1.0, 0.3, 0.1]), (0.5, [0.2, 0.9, 0.3]), (1.0, [0.3, 0.4, 1.0])],
    );
    let place = placed(&**source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let mut frame = frame(display, place, optics, Some(Light::default()));
    // A ray through thin media is not to end before it has begun.
    frame.quality.termination = 0.0;
    frame
}

/// Errors where the largest true opacity counts as 1, of the pictures times `factor`.
fn relative_errors(images: &[ProjectorImage], truth: &[TruePixel], factor: f64) -> Errors {
    let most = truth.iter().map(|pixel| pixel.truth.opacity).fold(0.0, f64::max);
    assert!(most > 0.0, "there is nothing to see");
    errors_of(truth.iter().map(|pixel| {
        let image = images.iter().find(|image| image.projector == pixel.projector).unwrap();
        let at = 4 * (pixel.y as usize * image.width as usize + pixel.x as usize);
        let [r, g, b] = pixel.truth.rgb.to_array();
        let found: [f64; 4] = std::array::from_fn(|c| factor * f64::from(image.rgba[at + c]) / most);
        (found, [r, g, b, pixel.truth.opacity].map(|n| n / most))
    }))
}

#[test]
fn thin_media_keep_their_digits() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap().with_rasters(97, 73);
    let source: Arc<dyn BrickSource> =
        Arc::new(ClosureVolume::new(UVec3::new(56, 40, 30), (0.0, 1.0), bumps));
    for exponent in [-6, -5, -4, -3, -2] {
        let frame = scene(&display, &source, 10f64.powi(exponent));
        let truth = truth(&display, &frame, &source, &PROJECTORS, 1);
        for device in draw::devices() {
            let images = draw(&display, &frame, &source, &PROJECTORS, With::device(device)).images;
            let errors = relative_errors(&images, &truth, 1.0);
            println!("up to 1e{exponent} per voxel, {device:?}: {errors}");
            assert!(KEPT.hold(&errors) && errors.lit > 500, "1e{exponent}, {device:?}: {errors}");
            let spoilt = relative_errors(&images, &truth, THOUSANDTHS);
            assert!(!KEPT.hold(&spoilt), "1e{exponent}, {device:?}: 2 % more light passes: {spoilt}");
        }
    }
}
