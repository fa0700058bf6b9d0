//! The twin alone: what rounding costs it, and that a spoiled twin does not pass for a good one.

use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use layout::TableEntry;
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::{Errors, Limits, TruePixel, errors_of, truth};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques;
use lightloom_tests::twin_scene::{TwinScene, view};
use optics::MimdaForm;
use protocol::{DeviceChoice, FrameState};
use std::sync::Arc;
use twin::Real;

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// f32 against f64 of one algorithm: rounding, and steps and parts that it takes one more or one less of; see the
/// comparison of kernel and twin, which both round.
const ROUNDING: Limits = Limits::of_255(0.005, 0.05, 1.5);
/// What default quality keeps on every scene.
const KEPT: Limits = Limits::of_255(0.15, 1.5, 4.0);

/// Every `stride`-th pixel of a raster, where `compare::truth` takes them.
fn pixels(display: &Display, projector: u32, stride: u32) -> Vec<(u32, u32)> {
    let raster = &display.projectors[projector as usize].raster;
    let along = |n: u32| (stride / 2..n).step_by(stride as usize);
    along(raster.height).flat_map(|y| along(raster.width).map(move |x| (x, y))).collect()
}

fn numbers<F: Real>(rgba: Vec<[F; 4]>) -> impl Iterator<Item = [f64; 4]> {
    rgba.into_iter().map(|rgba| rgba.map(|n| f64::from(n.to_f32())))
}

#[test]
fn f32_costs_no_more_than_rounding() {
    let _turn = draw::turn();
    let display = scenes::small_desk8(160, 120);
    let mut all = scenes::all(&display);
    all.extend(scenes::cranium_mimda(&display, MimdaForm::Paper));
    for scene in all {
        let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
        let pairs = PROJECTORS.iter().flat_map(|&projector| {
            let view = view(&display, projector, &scene.frame, &*scene.source);
            let pixels = pixels(&display, projector, 1);
            numbers(twin.cast(&view.rounded(), &pixels)).zip(numbers(twin.cast(&view, &pixels)))
        });
        let errors = errors_of(pairs);
        println!("{:28} f32 against f64: {errors}", scene.name);
        assert!(ROUNDING.hold(&errors), "{}: {errors}", scene.name);
    }
}

/// In media so thin that little can hide between two samples, `step_voxels` changes nothing, but where all steps have its length:
/// so says the page on scenes.
#[test]
fn steps_grow_in_thin_media_whatever_their_length() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap().with_rasters(32, 24);
    let mut scene = techniques::bumps(&display);
    let (extinction, colours) = (vec![(0.0, 1e-5), (1.0, 2e-5)], vec![(0.0, [1.0; 3])]);
    scene.frame.optics = scenes::optics((0.0, 1.0), &extinction, &colours);
    scene.frame.light = None;
    let mut samples = |step_voxels, tolerance| -> u32 {
        (scene.frame.quality.step_voxels, scene.frame.quality.tolerance) = (step_voxels, tolerance);
        let view = view(&display, PROJECTORS[1], &scene.frame, &*scene.source).rounded();
        let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
        twin.cast_whole::<f32>(&view, &pixels(&display, PROJECTORS[1], 1))
            .iter()
            .map(|cast| cast.samples)
            .sum()
    };
    let grown = samples(0.4, 1e-4);
    assert!(grown > 1000, "{grown}");
    assert_eq!([samples(0.05, 1e-4), samples(1.0, 1e-4)], [grown; 2]);
    let [long, short] = [0.4, 0.05].map(|step| samples(step, 1.0));
    assert!((7 * long..9 * long).contains(&short), "{short} samples, {long} with steps eight times as long");
}

#[test]
fn a_scene_put_together_by_hand_is_what_the_cpu_device_draws() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap();
    let scene = scenes::shells(&display);
    let drawn =
        draw(&display, &scene.frame, &scene.source, &PROJECTORS, With::device(DeviceChoice::Cpu)).images;
    let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
    for image in drawn {
        let view = view(&display, image.projector, &scene.frame, &*scene.source).rounded();
        let by_hand = twin.cast(&view, &pixels(&display, image.projector, 1));
        assert!(by_hand.as_flattened() == image.rgba, "projector {}", image.projector);
    }
}

/// Errors of the f32 twin against the truth of one projector, taken at `stride`.
fn against(
    display: &Display,
    scene: &TestScene,
    twin: &TwinScene,
    truth: &[TruePixel],
    stride: u32,
) -> Errors {
    let view = view(display, truth[0].projector, &scene.frame, &*scene.source).rounded();
    let found = numbers(twin.cast(&view, &pixels(display, truth[0].projector, stride)));
    errors_of(found.zip(truth).map(|(found, pixel)| {
        let [r, g, b] = pixel.truth.rgb.to_array();
        (found, [r, g, b, pixel.truth.opacity])
    }))
}

/// A smooth field far from the part of its transfer function that is a million times as dense.
fn beside_a_spike(display: &Display) -> TestScene {
    let bumps = |p: DVec3| 0.5 + 0.3 * (0.2 * p.x).sin() * (0.15 * p.y).cos() * (0.1 * p.z + 1.0).sin();
    let source: Arc<dyn BrickSource> = Arc::new(ClosureVolume::new(UVec3::splat(56), (0.0, 1.0), bumps));
    let optics = scenes::optics(
        (0.0, 1.0),
        &vec![(0.0, 1e6), (0.1, 1e6), (0.1, 0.01), (1.0, 0.03)],
        &vec![(0.0, [1.0, 0.2, 0.1]), (1.0, [0.2, 0.9, 0.7])],
    );
    let place = scenes::placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let frame: FrameState = scenes::frame(display, place, optics, None);
    TestScene { name: "beside a spike", source, frame }
}

#[test]
fn a_spoiled_twin_is_found_out() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap();
    let stride = 2;
    type Spoil = fn(&mut TwinScene);
    let spikes: [(&str, Spoil); 1] = [("no rest of integrals", |twin| {
        twin.tables.optics.iter_mut().for_each(|e| e.integral_rest = [0.0; 4])
    })];
    let shapes: [(&str, Spoil); 3] = [
        ("a table shifted by one entry", |twin| {
            let before = twin.tables.optics.clone();
            for (entry, before) in twin.tables.optics[1..].iter_mut().zip(before) {
                *entry = TableEntry { position: entry.position, ..before };
            }
        }),
        ("an overlap of one sample less", |twin| twin.atlas.rotate_right(1)),
        ("integrals that end one entry early", |twin| {
            let integrals: Vec<_> =
                twin.tables.optics.iter().map(|e| (e.integral, e.integral_rest)).collect();
            for (entry, before) in twin.tables.optics[1..].iter_mut().zip(integrals) {
                (entry.integral, entry.integral_rest) = before;
            }
        }),
    ];
    for (scene, spoils) in
        [(beside_a_spike(&display), &spikes[..]), (scenes::marschner_lobb(&display), &shapes[..])]
    {
        let truth = truth(&display, &scene.frame, &scene.source, &PROJECTORS[1..], stride);
        let good = TwinScene::new(&display, &scene.frame, &*scene.source);
        let errors = against(&display, &scene, &good, &truth, stride);
        println!("{:28} {errors}", scene.name);
        assert!(KEPT.hold(&errors), "{}: {errors}", scene.name);
        for (what, spoil) in spoils {
            let mut spoiled = good.clone();
            spoil(&mut spoiled);
            let errors = against(&display, &scene, &spoiled, &truth, stride);
            println!("{:28} {what}: {errors}", "");
            assert!(!KEPT.hold(&errors), "{}: {what} passes", scene.name);
        }
    }
}
