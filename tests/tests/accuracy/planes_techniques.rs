//! Row planes of every technique: what follows a sample is the rays' own code, and shows what the reference has.

use display_config::Display;
use lightloom_tests::compare::{self, Limits};
use lightloom_tests::draw::{self, With};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques::{self, TECHNIQUES};
use optics::{Curve, DebugView, Mimda, MimdaForm};
use protocol::{Caster, CasterChoice, DeviceChoice};

const ALL: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
/// One projector from the side and one near the middle.
const COMPARED: [u32; 2] = [1, 5];

fn display() -> Display {
    scenes::small_desk8(160, 120)
}

/// A base with importance accumulated in a form.
fn accumulated(base: &TestScene, name: &'static str, form: MimdaForm) -> TestScene {
    let mut scene = TestScene { name, ..base.clone() };
    let importance = Curve::new(vec![(0.3, 0.0), (0.45, 0.5), (0.6, 0.9)]).unwrap();
    scene.frame.optics.mimda = Some(Mimda { importance, gamma: 1.0, form });
    scene
}

/// Techniques that ask most of planes on a GPU: all enhancers but one with importance, another level at each sample, rises of importance.
const HARDEST: [&str; 3] =
    ["picker, probe and clip plane with MImDA", "detail over levels", "MImDA, as published"];

/// What planes keep of a smooth field, about 1.5 times what they err: as without techniques, a scalar half-way between two samples.
const SMOOTH: Limits = Limits::of_255(0.22, 3.0, 3.6);
/// The same of real data; without techniques they keep 0.5, 6 and 9 there.
const REAL: Limits = Limits::of_255(0.8, 12.0, 15.0);
/// Coarse levels, which scenes with the techniques below ask for, change more from sample to sample.
const REAL_OVER_LEVELS: Limits = Limits::of_255(0.9, 17.0, 20.0);
fn limits_of(base: &TestScene, scene: &TestScene) -> Limits {
    match scene.name {
        _ if base.name == "bumps" => SMOOTH,
        "quadrilinear filtering" | "detail over levels" => REAL_OVER_LEVELS,
        _ => REAL,
    }
}

/// A base with every technique but refraction.
fn all_of(base: &TestScene) -> Vec<TestScene> {
    let named = TECHNIQUES.iter().map(|(name, _)| techniques::with(base, name));
    let mut all: Vec<_> = named.filter(|scene| scene.frame.optics.refraction.is_none()).collect();
    all.push(accumulated(base, "MImDA, as published", MimdaForm::Paper));
    all.push(accumulated(base, "MImDA, consistent", MimdaForm::Consistent));
    all
}

/// Draws a base with techniques by planes, against the reference on every so many pixels.
fn check(display: &Display, base: &TestScene, all: &[TestScene], stride: u32, with: With) {
    let plain = draw::draw(display, &base.frame, &base.source, &ALL, with);
    let mut failed = Vec::new();
    for scene in all {
        let truth = compare::traced(display, &scene.frame, &scene.source, &COMPARED, stride);
        let drawn = draw::draw(display, &scene.frame, &scene.source, &ALL, with);
        assert!(drawn.report.complete, "{}", drawn.report.shortfall);
        assert!(matches!(drawn.report.caster, Caster::Planes { .. }), "{:?}", drawn.report.caster);
        let found = compare::errors(&drawn.images, &truth);
        let limits = limits_of(base, scene);
        println!("{:10} {:40} {found}", base.name, scene.name);
        if !limits.hold(&found) {
            failed.push(format!("{}, {}: {found}", base.name, scene.name));
        }
        // The canary: without the technique it is another picture.
        let without = compare::errors(&plain.images, &truth);
        let name = scene.name;
        assert!(!limits.hold(&without), "{}, {name}: the plain picture passes: {without}", base.name);
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn planes_cast_every_technique_but_refraction() {
    let _turn = draw::turn();
    let display = display();
    for base in techniques::bases(&display) {
        check(&display, &base, &all_of(&base), 4, With::PLANES);
    }
}

#[test]
fn planes_on_a_gpu_cast_every_technique_but_refraction() {
    if !draw::has_gpu() {
        return;
    }
    let _turn = draw::turn();
    let display = scenes::small_desk8(64, 48);
    let [smooth, real @ ..] = &techniques::bases(&display)[..] else {
        panic!("there is always a smooth one")
    };
    check(&display, smooth, &all_of(smooth), 2, With::PLANES_ON_GPU);
    // Compiling takes a driver in software ten seconds each: of real data those that ask most.
    for base in real {
        let mut all = all_of(base);
        all.retain(|scene| HARDEST.contains(&scene.name));
        assert_eq!(all.len(), HARDEST.len());
        check(&display, base, &all, 2, With::PLANES_ON_GPU);
    }
}

#[test]
fn debug_views_of_nodes_are_those_of_rays() {
    let _turn = draw::turn();
    let display = display();
    let base = techniques::bumps(&display);
    for view in [DebugView::Lod, DebugView::Weights] {
        let mut scene = base.clone();
        scene.frame.debug = Some(view);
        let drawn = |caster| {
            let with = With { caster, ..With::device(DeviceChoice::Cpu) };
            draw::draw(&display, &scene.frame, &scene.source, &ALL, with).images
        };
        let errors = compare::errors_between(&drawn(CasterChoice::Planes), &drawn(CasterChoice::Rays));
        println!("{view:?}: {errors}");
        assert!(SMOOTH.hold(&errors), "{view:?}: {errors}");
    }
}

#[test]
fn auto_leaves_to_rays_what_goes_pixel_by_pixel() {
    let _turn = draw::turn();
    let display = Display::load("holo72").unwrap().with_rasters(32, 24);
    let mut scene = techniques::with(&techniques::bumps(&display), "band picker");
    let caster = |scene: &TestScene, caster| {
        let with = With { caster, ..With::device(DeviceChoice::Cpu) };
        draw::draw(&display, &scene.frame, &scene.source, &[0, 5], with).report.caster.to_string()
    };
    assert!(caster(&scene, CasterChoice::Auto).starts_with("rays: importance, enhancers, materials"));
    assert_eq!(caster(&scene, CasterChoice::Planes), "row planes, each for 2 views");
    scene.frame.debug = Some(DebugView::Samples);
    assert!(caster(&scene, CasterChoice::Auto).starts_with("rays: the samples of each ray are counted"));
}
