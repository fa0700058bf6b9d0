//! The kernel on the GPU against its f32 twin on the CPU: they tell the same picture to rounding.

use display_config::Display;
use lightloom_tests::compare::{Limits, errors_between};
use lightloom_tests::draw::{self, Drawn, With, draw};
use lightloom_tests::scenes::{self, TestScene, scaled};
use optics::{Light, MimdaForm};
use protocol::{DeviceChoice, FilterChoice, FrameState, ProjectorImage};

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];

/// RMS: the rounding of some hundred composited steps, a few 1e-8 each. 99.9 % and max: where a length sits on a whole
/// number of steps, or an error estimate on a whole number of parts, rounding gives one of the two one more than the
/// other, and the pixel differs by a part of what the integration errs there, which is up to 4/255.
const SAME_TO_ROUNDING: Limits = Limits::of_255(0.002, 0.02, 1.0);

/// The texture unit is asked at points rounded to 1/4096 texel, which is what makes its samples independent of the slot.
/// Half of that, on slopes of up to a third of the range per voxel, moves a scalar by up to 4e-5; steep curves of
/// extinction and importance make that up to ten times as much per step. Near the knot where importance begins, a step
/// more or less is cut into parts, and the pixel differs by a part of what the integration errs there.
const SAME_TO_THE_GRID: Limits = Limits::of_255(0.01, 0.05, 4.0);

/// An error of extinction that nobody would see; it must not pass for rounding.
const UNSEEN_EXTINCTION: f64 = 1.001;

fn every_scene(display: &Display) -> Vec<TestScene> {
    let mut all = scenes::all(display);
    all.extend(scenes::cranium_mimda(display, MimdaForm::Paper));
    all
}

/// The frame with one thing wrong, by name.
fn spoilt(frame: &FrameState) -> Vec<(&'static str, FrameState)> {
    let with = |change: &dyn Fn(&mut FrameState)| {
        let mut frame = frame.clone();
        change(&mut frame);
        frame
    };
    let mut all = vec![
        (
            "0.1 % more extinction",
            with(&|f| f.optics.extinction = scaled(&f.optics.extinction, UNSEEN_EXTINCTION)),
        ),
        ("the other shading", with(&|f| f.light = f.light.is_none().then(Light::default))),
    ];
    if frame.optics.mimda.is_some() {
        let other = |form| match form {
            MimdaForm::Paper => MimdaForm::Consistent,
            MimdaForm::Consistent => MimdaForm::Paper,
        };
        let swap = |f: &mut FrameState| f.optics.mimda.iter_mut().for_each(|m| m.form = other(m.form));
        all.push(("the other form of MImDA", with(&swap)));
    }
    all
}

fn assert_canaries_fail(display: &Display, scene: &TestScene, kernel: &[ProjectorImage]) {
    for (what, frame) in spoilt(&scene.frame) {
        let twin = draw(display, &frame, &scene.source, &PROJECTORS, With::device(DeviceChoice::Cpu));
        let errors = errors_between(kernel, &twin.images);
        println!("{:28} {what}: {errors}", "");
        assert!(!SAME_TO_ROUNDING.hold(&errors), "{}: {what} passes for rounding", scene.name);
    }
}

#[test]
fn kernel_and_twin_tell_the_same_picture() {
    let _turn = draw::turn();
    if !draw::has_gpu() {
        return;
    }
    let display = scenes::small_desk8(80, 60);
    for scene in every_scene(&display) {
        let draw = |device, filter| -> Drawn {
            let with = With { filter, ..With::device(device) };
            draw(&display, &scene.frame, &scene.source, &PROJECTORS, with)
        };
        let twin = draw(DeviceChoice::Cpu, FilterChoice::Exact);
        // The default is the texture unit exactly where it was measured to be precise.
        let filters = [FilterChoice::Exact, FilterChoice::Auto];
        let kernels = filters.map(|filter| draw(DeviceChoice::Gpu, filter));
        for kernel in &kernels {
            let errors = errors_between(&kernel.images, &twin.images);
            println!("{:28} {}: {errors}", scene.name, kernel.info.filter);
            let limits = if kernel.info.filter == "exact" { SAME_TO_ROUNDING } else { SAME_TO_THE_GRID };
            assert!(limits.hold(&errors), "{}, {}: {errors}", scene.name, kernel.info.filter);
        }
        assert_canaries_fail(&display, &scene, &kernels[0].images);
    }
}

#[test]
fn an_imprecise_texture_unit_is_not_the_default() {
    let _turn = draw::turn();
    if !draw::has_gpu() {
        return;
    }
    let display = scenes::small_desk8(160, 120);
    let scene = scenes::marschner_lobb(&display);
    let draw = |filter| {
        let with = With { filter, ..With::device(DeviceChoice::Gpu) };
        draw(&display, &scene.frame, &scene.source, &PROJECTORS[..1], with)
    };
    let (exact, hardware) = (draw(FilterChoice::Exact), draw(FilterChoice::Hardware));
    let errors = errors_between(&hardware.images, &exact.images);
    let by_default = draw(FilterChoice::Auto).info.filter;
    println!("{}: the texture unit differs by {errors}; the default is {by_default}", hardware.info.adapter);
    assert_eq!((exact.info.filter.as_str(), hardware.info.filter.as_str()), ("exact", "hardware"));
    assert!(by_default == "exact" || SAME_TO_THE_GRID.hold(&errors), "{errors}");
}
