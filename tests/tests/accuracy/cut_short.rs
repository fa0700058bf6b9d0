//! Rays that a driver gives up on: their light is whole, or the report says that it is not.

use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, UVec3};
use lightloom_tests::closure_volume::{ClosureVolume, bumps};
use lightloom_tests::draw::{self, Drawn, With, draw};
use lightloom_tests::scenes::{frame, optics, placed};
use optics::{Curve, Light};
use protocol::{DeviceChoice, ProjectorImage};
use std::sync::Arc;

/// The largest difference of a pixel to that of the CPU, in parts of 1: rounding of 10⁵ steps that are the same on both.
const SAME_TO_ROUNDING: f32 = 1e-3;
const PROJECTOR: u32 = 5;

fn is_said(drawn: &Drawn) -> bool {
    !drawn.report.complete && drawn.report.shortfall.contains("gave up on rays")
}

fn difference(one: &ProjectorImage, other: &ProjectorImage) -> f32 {
    one.rgba.iter().zip(&other.rgba).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn light_is_whole_or_the_report_says_that_it_is_not() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap().with_rasters(17, 13);
    let volume: Arc<dyn BrickSource> =
        Arc::new(ClosureVolume::new(UVec3::new(56, 40, 30), (0.0, 1.0), bumps));
    let place = placed(&*volume, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let curve = |points: &[(f64, f64)]| Some(Curve::new(points.to_vec()).unwrap());
    for (way, refraction) in [("straight", None), ("bent", curve(&[(0.0, 1.0), (1.0, 1.02)]))] {
        for (steps, step_voxels) in [("few", 0.5), ("many", 7e-4)] {
            let light =
                optics((0.0, 1.0), &vec![(0.2, 0.0), (0.6, 0.05), (1.0, 0.2)], &vec![(0.0, [1.0, 0.5, 0.2])]);
            let mut frame = frame(&display, place, light, Some(Light::default()));
            frame.optics.refraction = refraction.clone();
            // All of one length: in thin media those of a tolerance would grow.
            (frame.quality.step_voxels, frame.quality.tolerance) = (step_voxels, 1.0);
            let draw = |device| draw(&display, &frame, &volume, &[PROJECTOR], With::device(device));
            let on_cpu = draw(DeviceChoice::Cpu);
            assert!(on_cpu.report.complete, "{way}, {steps} steps: {}", on_cpu.report.shortfall);
            for device in draw::devices() {
                let drawn = draw(device);
                let difference = difference(&drawn.images[0], &on_cpu.images[0]);
                println!("{way}, {steps} steps, {device:?}: {difference:.6}, {:?}", drawn.report.shortfall);
                assert!(is_said(&drawn) || difference < SAME_TO_ROUNDING, "{way}, {steps} steps, {device:?}");
                // The canary: it is not said of every picture.
                assert!(steps == "many" || !is_said(&drawn), "{way}, {device:?}");
            }
        }
    }
}
