//! Coarse voxels that stand for many: kernel, twin and reference agree on what they show, and it is nearer to the finest level.

use display_config::Display;
use lightloom_tests::compare::{Limits, errors, errors_between, truth};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::twin_scene::TwinScene;
use optics::MimdaForm;
use protocol::{DeviceChoice, FilterChoice, ProjectorImage};

const PROJECTORS: [u32; 1] = [5];
const STRIDE: u32 = 1;
/// Default quality, as on every scene: see the module `reference`.
const KEPT: Limits = Limits::of_255(0.15, 1.5, 4.0);
/// Kernel and twin, which both round: see the module `devices`.
const ROUNDING: Limits = Limits::of_255(0.005, 0.05, 1.5);

fn display() -> Display {
    Display::load("desk8").unwrap().with_rasters(96, 72)
}

/// Scenes of stores whose coarse levels are shown.
fn coarse_scenes(display: &Display) -> Vec<TestScene> {
    let mut all = vec![scenes::stored_vessels(display)];
    all.extend(scenes::cranium(display));
    all.extend(scenes::cranium_mimda(display, MimdaForm::Consistent));
    let at = |lod_scale| move |scene: TestScene| coarsened(scene, lod_scale);
    all.into_iter().map(at(2.0)).chain(std::iter::once(scenes::noise(display)).map(at(4.0))).collect()
}

fn coarsened(mut scene: TestScene, lod_scale: f64) -> TestScene {
    scene.frame.quality.lod_scale = lod_scale;
    scene
}

fn drawn(display: &Display, scene: &TestScene, with: With) -> Vec<ProjectorImage> {
    draw(display, &scene.frame, &scene.source, &PROJECTORS, with).images
}

#[test]
fn what_coarse_voxels_stand_for_is_shown_as_the_reference_has_it() {
    let _turn = draw::turn();
    let display = display();
    for scene in coarse_scenes(&display) {
        let truth = truth(&display, &scene.frame, &scene.source, &PROJECTORS, STRIDE);
        for device in draw::devices() {
            let errors = errors(&drawn(&display, &scene, With::device(device)), &truth);
            println!("{:28} {device:?}: {errors}", scene.name);
            assert!(KEPT.hold(&errors), "{}: {errors}", scene.name);
        }
        // The canary: a picture by the means alone is another one.
        let mut means = scene.clone();
        means.frame.quality.deviation = false;
        let spoiled = errors(&drawn(&display, &means, With::device(DeviceChoice::Cpu)), &truth);
        println!("{:28} by means alone: {spoiled}", scene.name);
        assert!(!KEPT.hold(&spoiled), "{}: {spoiled}", scene.name);
    }
}

#[test]
fn kernel_and_twin_agree_on_it() {
    let _turn = draw::turn();
    let display = display();
    for scene in coarse_scenes(&display) {
        let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
        assert!(twin.needs.spreads, "{}: there is nothing to agree on", scene.name);
        let exact = |device| With { filter: FilterChoice::Exact, ..With::device(device) };
        if draw::has_gpu() {
            let [kernel, twin] =
                [DeviceChoice::Gpu, DeviceChoice::Cpu].map(|device| drawn(&display, &scene, exact(device)));
            let errors = errors_between(&kernel, &twin);
            println!("{:28} kernel against twin: {errors}", scene.name);
            assert!(ROUNDING.hold(&errors), "{}: {errors}", scene.name);
        }
    }
}

/// Error of coarse levels with deviations over that without: detail that is lost stays lost, but light and colour come back.
const MOST_OF_IT: f64 = 0.95;
/// Of noise hardly anything shows in its means.
const MOST_OF_NOISE: f64 = 0.5;

#[test]
fn coarse_levels_are_nearer_to_the_finest() {
    let _turn = draw::turn();
    let display = display();
    for mut scene in coarse_scenes(&display) {
        let finest = coarsened(scene.clone(), 0.0);
        let truth = truth(&display, &finest.frame, &scene.source, &PROJECTORS, STRIDE);
        let [with, without] = [true, false].map(|deviation| {
            scene.frame.quality.deviation = deviation;
            errors(&drawn(&display, &scene, With::device(DeviceChoice::Cpu)), &truth)
        });
        println!("{:28} with {with} without {without}", scene.name);
        let most = if scene.name == "noise" { MOST_OF_NOISE } else { MOST_OF_IT };
        assert!(with.rms < most * without.rms, "{}: {with} with, {without} without", scene.name);
    }
}
