//! Both devices at default quality against the reference, on every scene.

use bricks::store::EightBits;
use display_config::Display;
use lightloom_tests::compare::{Errors, Limits, TruePixel, cells, errors, heads, truth};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, TestScene, scaled};
use optics::{Light, MimdaForm};
use protocol::{DeviceChoice, FrameState, ProjectorImage};
use std::sync::Arc;

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// What default quality keeps, so that a slow loss shows: a fifth and more above the most that whole pictures of any scene err.
const KEPT: Limits = Limits::of_255(0.03, 0.35, 3.5);
/// The same where importance erases what lies before it.
const KEPT_WITH_MIMDA: Limits = Limits::of_255(0.085, 1.5, 3.2);
/// Pixels that make a comparison.
const ENOUGH_PIXELS: usize = 4_000;
/// Of them with something to see.
const ENOUGH_LIT: usize = 550;

fn kept(scene: &TestScene) -> Limits {
    if scene.frame.optics.mimda.is_some() { KEPT_WITH_MIMDA } else { KEPT }
}

/// Pixels between those compared: scenes of which little is lit are compared whole.
fn stride(scene: &TestScene) -> u32 {
    if ["shells", "sparse-vessels"].contains(&scene.name) { 1 } else { 2 }
}

/// A scene with one thing wrong.
fn spoilt(scene: &TestScene) -> Vec<(&'static str, TestScene)> {
    let with = |change: &dyn Fn(&mut FrameState)| {
        let mut scene = scene.clone();
        change(&mut scene.frame);
        scene
    };
    let coarse = |f: &mut FrameState| (f.quality.step_voxels, f.quality.tolerance) = (4.0, f64::INFINITY);
    let swap = |f: &mut FrameState| f.optics.mimda.iter_mut().for_each(|m| m.form = MimdaForm::Paper);
    let mut all = vec![
        ("steps of 4 voxels", with(&coarse)),
        ("2 % more extinction", with(&|f| f.optics.extinction = scaled(&f.optics.extinction, 1.02))),
        ("levels too coarse", with(&|f| f.quality.lod_scale = 8.0)),
        ("the other shading", with(&|f| f.light = f.light.is_none().then(Light::default))),
    ];
    if scene.frame.optics.mimda.is_some() {
        all.push(("MImDA as published", with(&swap)));
    }
    all
}

/// The scene with 8 bits per brick must err so many times as much: only a transfer function that is steep against the
/// range of a brick shows the loss of low bits.
const LOSS_OF_BITS: f64 = 1.5;

fn in_eight_bits(scene: &TestScene) -> TestScene {
    TestScene { source: Arc::new(EightBits::new(Arc::clone(&scene.source))), ..scene.clone() }
}

fn errors_of(display: &Display, scene: &TestScene, device: DeviceChoice, truth: &[TruePixel]) -> Errors {
    let drawn = draw(display, &scene.frame, &scene.source, &PROJECTORS, With::device(device));
    assert!(drawn.report.complete, "{}", drawn.report.shortfall);
    assert_is_light(&drawn.images);
    errors(&drawn.images, truth)
}

/// Neither NaN nor infinite nor negative.
fn assert_is_light(images: &[ProjectorImage]) {
    let numbers = images.iter().flat_map(|image| &image.rgba);
    assert!(numbers.clone().all(|n| n.is_finite() && *n >= 0.0), "a pixel is no light");
}

#[test]
fn default_quality_keeps_its_promise_on_every_scene() {
    let _turn = draw::turn();
    let display = scenes::small_desk8(160, 120);
    let mut results = Results::new(Program::Tests("accuracy"), "accuracy", "every scene");
    results.line(heads(["scene", "device"]));
    for scene in scenes::all(&display) {
        let truth = truth(&display, &scene.frame, &scene.source, &PROJECTORS, stride(&scene));
        for device in draw::devices() {
            let errors = errors_of(&display, &scene, device, &truth);
            results.line(format!("| {} | {device:?} | {} |", scene.name, cells(&errors)));
            assert!(kept(&scene).hold(&errors), "{}, {device:?}: {errors}", scene.name);
            assert!(errors.pixels >= ENOUGH_PIXELS && errors.lit >= ENOUGH_LIT, "{errors}");
        }
        for (what, spoilt) in spoilt(&scene) {
            let errors = errors_of(&display, &spoilt, DeviceChoice::Cpu, &truth);
            println!("{:28} {what}: {errors}", "");
            assert!(!kept(&scene).hold(&errors), "{}: {what} passes", scene.name);
        }
        if scene.name == "cranium" {
            let [whole, eight] = [scene.clone(), in_eight_bits(&scene)]
                .map(|scene| errors_of(&display, &scene, DeviceChoice::Cpu, &truth));
            println!("{:28} eight bits per brick: {eight}", "");
            assert!(eight.rms > LOSS_OF_BITS * whole.rms, "eight bits per brick pass");
        }
    }
    results.finish().unwrap();
}
