//! Numbers at the ends of single precision.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{frame, optics, placed, with_raster};
use optics::{BandPicker, Enhancer, LayerOpacity, Ramp, Trapezoid};
use protocol::{FrameState, ProjectorImage};
use std::sync::Arc;

const PROJECTORS: [u32; 2] = [1, 5];

fn display() -> Display {
    with_raster(&Display::load("desk8").unwrap(), 61, 45)
}

fn volume(value: impl Fn(DVec3) -> f64 + Send + Sync + 'static) -> Arc<dyn BrickSource> {
    Arc::new(ClosureVolume::new(UVec3::splat(56), (0.0, 1.0), value))
}

fn bumps(p: DVec3) -> f64 {
    0.5 + 0.4 * (0.35 * p.x).sin() * (0.3 * p.y + 0.5).cos() * (0.25 * p.z + 1.0).sin()
}

fn scene(display: &Display, source: &Arc<dyn BrickSource>, turn: f64) -> FrameState {
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.0, 0.0), (0.2, 0.03), (0.8, 0.03)],
        &vec![(0.0, [1.0, 0.0, 0.0]), (0.5, [0.0, 1.0, 0.0]), (1.0, [0.0, 0.0, 1.0])],
    );
    let place = placed(&**source, 0.6 * display.height_m, DQuat::from_rotation_y(turn));
    let mut frame = frame(display, place, optics, None);
    frame.quality.lod_scale = 0.0;
    frame
}

fn what_is_no_light(images: &[ProjectorImage]) -> usize {
    images.iter().flat_map(|image| &image.rgba).filter(|n| !(n.is_finite() && **n >= 0.0)).count()
}

#[test]
fn numbers_that_f32_cannot_hold_are_refused_or_are_light() {
    let _turn = draw::turn();
    let display = display();
    let source = volume(bumps);
    let axis_in_display = DVec3::NEG_Z;
    let band = Trapezoid::new([0.4, 0.5, 0.6, 0.7]).unwrap();
    // In f32 both limits are 1, which the middle pixel meets.
    let facing = Ramp { low: 0.999_999_99, high: 1.0 };
    let endless = Trapezoid::new([-1e39, 0.5, 0.6, 0.7]).unwrap();
    let steep = Enhancer::BandPicker(BandPicker { band, axis_in_display, facing, strength: 1.0 });
    let links = [Enhancer::LayerOpacity(LayerOpacity {
        band: endless,
        axis_in_display,
        facing: Ramp { low: 0.0, high: 0.5 },
        away: 1.0,
        toward: 0.1,
    })];
    let mut failed = Vec::new();
    for link in links {
        let mut frame = scene(&display, &source, 0.0);
        frame.eta = 0.0;
        frame.optics.enhancers = vec![link];
        assert_eq!(frame.optics.check(), Ok(()));
        let mut refused = frame.clone();
        refused.optics.enhancers = vec![steep];
        assert!(refused.optics.check().is_err());
        for device in draw::devices() {
            let images = draw(&display, &frame, &source, &PROJECTORS, With::device(device)).images;
            if what_is_no_light(&images) > 0 {
                failed.push(format!("{device:?}, {link:?}: {} numbers", what_is_no_light(&images)));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
