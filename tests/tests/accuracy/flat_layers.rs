//! Bent light in flat layers, where Snell's law is all there is.

use super::layers::{PROJECTORS, display, scene, volume};
use bricks::BrickSource;
use glam::DVec3;
use lightloom_tests::closure_volume::bumps;
use lightloom_tests::compare::{self, Limits, errors_between};
use lightloom_tests::draw::{self, With, draw};
use optics::Curve;
use protocol::{DeviceChoice, FilterChoice};
use std::sync::Arc;

/// What default quality keeps: a quarter above the most that was measured.
const KEPT: Limits = Limits::of_255(0.2, 2.7, 2.7);
/// The same where one ray of 600 grazes the layer and turns by the grid of a texture unit.
const KEPT_WHERE_ONE_GRAZES: Limits = Limits::of_255(0.6, 10.0, 10.0);

/// Pixels of which the reference does not reach its own tolerance, at most.
const MOST_UNKNOWN: usize = 0;

/// Flat layers, whose normal is turned by some degrees from z; s changes by a tenth per voxel.
fn layers(degrees: f64) -> Arc<dyn BrickSource> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    volume(move |p| (0.5 + 0.1 * DVec3::new(sin, 0.0, cos).dot(p - 28.0)).clamp(0.0, 1.0))
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
            let all = truth.len();
            let truth: Vec<_> = truth.into_iter().filter(|pixel| pixel.truth.reached).collect();
            let unknown = all - truth.len();
            println!("{name}, {degrees}°: {unknown} of {all} pixels without a truth");
            if unknown > MOST_UNKNOWN {
                failed.push(format!("{name}, {degrees}°: {unknown} pixels without a truth"));
            }
            for device in draw::devices() {
                let drawn = draw(&display, &frame, &source, &PROJECTORS, With::device(device));
                let errors = compare::errors(&drawn.images, &truth);
                println!("{name}, {degrees}°, {device:?}: {errors}");
                let grazes = device == DeviceChoice::Gpu && (name, degrees) == ("out of glass", 120.0);
                if !(if grazes { KEPT_WHERE_ONE_GRAZES } else { KEPT }).hold(&errors) {
                    failed.push(format!("{name}, {degrees}°, {device:?}: {errors}"));
                }
            }
            // The canary: straight rays, but where those that bend end next to them.
            let hardly_bends = (name, degrees) == ("out of glass", 0.0);
            frame.optics.refraction = None;
            let straight = draw(&display, &frame, &source, &PROJECTORS, With::device(DeviceChoice::Cpu));
            if !hardly_bends && KEPT.hold(&compare::errors(&straight.images, &truth)) {
                failed.push(format!("{name}, {degrees}°: straight rays pass"));
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
