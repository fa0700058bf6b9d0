//! Bent light in flat layers, where Snell's law is all there is.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::{self, Limits, errors_between};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{frame, optics, placed, with_raster};
use optics::Curve;
use protocol::{DeviceChoice, FilterChoice, FrameState};
use std::sync::Arc;

const PROJECTORS: [u32; 2] = [1, 5];
/// Rays at a graze apart, a flat layer parts no rays: what default quality keeps elsewhere, four times over.
const KEPT: Limits = Limits::of_255(2.0, 16.0, 16.0);

fn display() -> Display {
    with_raster(&Display::load("desk8").unwrap(), 61, 45)
}

fn volume(value: impl Fn(DVec3) -> f64 + Send + Sync + 'static) -> Arc<dyn BrickSource> {
    Arc::new(ClosureVolume::new(UVec3::splat(56), (0.0, 1.0), value))
}

fn bumps(p: DVec3) -> f64 {
    0.5 + 0.4 * (0.35 * p.x).sin() * (0.3 * p.y + 0.5).cos() * (0.25 * p.z + 1.0).sin()
}

/// Flat layers, whose normal is turned by some degrees from z; s changes by a tenth per voxel.
fn layers(degrees: f64) -> Arc<dyn BrickSource> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    volume(move |p| (0.5 + 0.1 * DVec3::new(sin, 0.0, cos).dot(p - 28.0)).clamp(0.0, 1.0))
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

#[test]
fn a_flat_layer_a_voxel_thick_bends_light_by_snells_law() {
    let _turn = draw::turn();
    let display = display();
    let mut failed = Vec::new();
    for (name, points) in
        [("into glass", [(0.45, 1.0), (0.55, 1.5)]), ("out of glass", [(0.45, 1.5), (0.55, 1.0)])]
    {
        for degrees in [0.0, 30.0, 50.0, 70.0, 120.0, 150.0, 180.0] {
            let source = layers(degrees);
            let mut frame = scene(&display, &source, 0.0);
            frame.optics.refraction = Some(Curve::new(points.to_vec()).unwrap());
            let truth = compare::traced(&display, &frame, &source, &PROJECTORS, 3);
            let truth: Vec<_> = truth.into_iter().filter(|pixel| pixel.truth.reached).collect();
            for device in draw::devices() {
                let drawn = draw(&display, &frame, &source, &PROJECTORS, With::device(device));
                let errors = compare::errors(&drawn.images, &truth);
                if !KEPT.hold(&errors) {
                    failed.push(format!("{name}, {degrees}°, {device:?}: {errors}"));
                }
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn long_steps_of_bent_light_stay_in_their_brick() {
    let _turn = draw::turn();
    if !draw::has_gpu() {
        return;
    }
    let display = display();
    let source = volume(bumps);
    let mut failed = Vec::new();
    for step_voxels in [0.4, 1.0, 2.0, 4.0] {
        let mut frame = scene(&display, &source, 0.4);
        frame.optics.refraction = Some(Curve::new(vec![(0.5, 1.0), (0.5, 1.5)]).unwrap());
        frame.quality.step_voxels = step_voxels;
        let picture = || {
            let with = With { filter: FilterChoice::Exact, ..With::device(DeviceChoice::Gpu) };
            draw(&display, &frame, &source, &PROJECTORS, with).images
        };
        let first = picture();
        // Loaders deliver bricks in any order, so slots differ from run to run.
        for _ in 0..6 {
            let errors = errors_between(&picture(), &first);
            if errors.max > 0.0 {
                failed.push(format!("steps of {step_voxels}: {errors}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
