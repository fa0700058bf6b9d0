//! Bent light: its order, mirrors, and that nothing wild is worse than wrong.

use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::{self, Limits, errors_between};
use lightloom_tests::draw::{self, With};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques;
use optics::Curve;
use protocol::{DeviceChoice, FilterChoice, ProjectorImage};
use std::sync::Arc;

const PROJECTORS: [u32; 2] = [1, 5];

fn test_display() -> Display {
    Display::load("desk8").unwrap().with_rasters(160, 120)
}

fn draw_on(display: &Display, scene: &TestScene, device: DeviceChoice) -> Vec<ProjectorImage> {
    let with = With { filter: FilterChoice::Exact, ..With::device(device) };
    let TestScene { frame, source, .. } = scene;
    let drawn = draw::drawn_once(display, frame, source, &PROJECTORS, with);
    let pixels = drawn.images.iter().flat_map(|image| image.rgba.as_chunks::<4>().0);
    for pixel in pixels {
        let is_light = pixel.iter().all(|n| n.is_finite() && *n >= 0.0) && pixel[3] <= 1.0 + 1e-5;
        assert!(is_light, "{}: {pixel:?} is no light", scene.name);
    }
    assert!(drawn.report.complete || drawn.is_left_by_llvmpipe(), "{}", drawn.report.shortfall);
    drawn.images.clone()
}

fn bent(mut scene: TestScene, index: Vec<(f64, f64)>) -> TestScene {
    scene.frame.optics.refraction = Some(Curve::new(index).unwrap());
    scene
}

/// The pictures of the CPU device at steps of one length.
fn at_step(display: &Display, scene: &TestScene, step_voxels: f64) -> Vec<ProjectorImage> {
    let mut scene = scene.clone();
    scene.frame.quality.step_voxels = step_voxels;
    scene.frame.quality.tolerance = f64::INFINITY;
    scene.frame.quality.termination = 0.0;
    draw_on(display, &scene, DeviceChoice::Cpu)
}

#[test]
fn the_error_falls_with_the_square_of_the_step_on_a_smooth_field() {
    let _turn = draw::turn();
    let display = test_display();
    // An index without kinks within the field's values, 0.2 to 0.8, and so gentle that no pair is halved for it.
    let mut scene = bent(techniques::bumps(&display), vec![(0.0, 1.0), (1.0, 1.1)]);
    scene.frame.light = None;
    // Large voxels beside the field's waves, so that steps of a quarter of one err by more than the reference.
    scene.frame.quality.lod_scale = 1e6;
    let pictures = [0.25, 0.125, 0.0625].map(|step| at_step(&display, &scene, step));
    let [first, second] = [0, 1].map(|i| errors_between(&pictures[i], &pictures[i + 1]));
    println!("from a quarter of a voxel to an eighth {first}, from there to a sixteenth {second}");
    // A second-order method gains 4 from a halving.
    assert!(first.rms > 2.8 * second.rms, "{first}, then {second}");
    let truth = compare::truth(&display, &scene.frame, &scene.source, &PROJECTORS, 4);
    let errors = compare::errors(&pictures[2], &truth);
    println!("at a sixteenth {errors}");
    // The reference keeps to RMS 0.003 itself.
    assert!(Limits::of_255(0.01, 0.1, 0.2).hold(&errors), "{errors}");
}

/// A surface across a box, seen at a slant: behind it the field is dense and red, before it thin and blue.
fn interface(display: &Display, slant_rad: f64) -> TestScene {
    let source: Arc<dyn BrickSource> =
        Arc::new(ClosureVolume::new(UVec3::new(50, 50, 50), (0.0, 1.0), |p: DVec3| p.z / 50.0));
    let optics = scenes::optics(
        (0.0, 1.0),
        &vec![(0.0, 0.3), (0.3, 0.1), (0.5, 0.005), (1.0, 0.03)],
        &vec![
            (0.0, [0.9, 0.1, 0.1]),
            (0.45, [0.9, 0.6, 0.1]),
            (0.55, [0.1, 0.6, 0.9]),
            (1.0, [0.1, 0.1, 0.9]),
        ],
    );
    let turn = DQuat::from_rotation_y(slant_rad);
    let place = scenes::placed(&*source, 0.5 * display.height_m, turn);
    TestScene { name: "interface", source, frame: scenes::frame(display, place, optics, None) }
}

/// Surfaces are met where they are, so that what is seen behind one errs as little as what is seen straight on.
const KEPT_AT_A_SURFACE: Limits = Limits::of_255(0.02, 0.2, 2.0);

#[test]
fn a_surface_breaks_light_and_mirrors_it_beyond_the_critical_angle() {
    let _turn = draw::turn();
    let display = test_display();
    // From 1.5 into 1.0 the critical angle is 41.8°.
    for (what, slant_deg) in [("below", 20.0_f64), ("around", 42.0), ("beyond", 65.0)] {
        let plain = interface(&display, slant_deg.to_radians());
        let index = vec![(0.5, 1.0), (0.5, 1.5)];
        let scene = bent(plain.clone(), index);
        let truth = compare::truth(&display, &scene.frame, &scene.source, &PROJECTORS, 4);
        let straight = compare::errors(&draw_on(&display, &plain, DeviceChoice::Cpu), &truth);
        for device in draw::devices() {
            let errors = compare::errors(&draw_on(&display, &scene, device), &truth);
            println!("{what}, {device:?}: {errors}; straight light: {straight}");
            assert!(KEPT_AT_A_SURFACE.hold(&errors), "{what}, {device:?}: {errors}");
        }
        assert!(!KEPT_AT_A_SURFACE.hold(&straight), "{what}: straight light passes: {straight}");
    }
}

#[test]
fn wild_indices_give_light_on_every_device() {
    let _turn = draw::turn();
    // What it is about needs no fine picture.
    let display = Display::load("desk8").unwrap().with_rasters(32, 24);
    let wild = [
        vec![(0.3, 0.1), (0.35, 5.0), (0.5, 0.2), (0.5, 3.0), (0.7, 0.01)],
        vec![(0.5, 1e-3), (0.5, 1e3)],
        vec![(0.49, 1.0), (0.5, 1e-3), (0.51, 1.0)],
    ];
    let mut bases = techniques::bases(&display);
    bases.push(scenes::shells(&display));
    for base in bases {
        for index in &wild {
            let scene = bent(base.clone(), index.clone());
            let pictures: Vec<_> =
                draw::devices().into_iter().map(|device| draw_on(&display, &scene, device)).collect();
            let plain = draw_on(&display, &base, DeviceChoice::Cpu);
            let effect = errors_between(&pictures[0], &plain);
            assert!(effect.rms > 0.0, "{}: {index:?} bends nothing", base.name);
        }
    }
}
