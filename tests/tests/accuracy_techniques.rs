//! Every illustrative technique: kernel, twin and reference tell one picture.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

use backend::protocol::{DeviceChoice, FilterChoice, ProjectorImage};
use display_config::Display;
use lightloom_tests::compare::{self, Limits, errors_between};
use lightloom_tests::draw::{self, Drawn, With, draw};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques::{self, TECHNIQUES};

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// What two ways to round cost: see the comparison of kernel and twin.
const SAME_TO_ROUNDING: Limits = Limits::of_255(0.004, 0.05, 1.5);

fn test_display() -> Display {
    scenes::with_raster(&Display::load("desk8").unwrap(), 160, 120)
}

fn draw_on(display: &Display, scene: &TestScene, device: DeviceChoice) -> Drawn {
    let with = With { filter: FilterChoice::Exact, ..With::device(device) };
    let drawn = draw(display, &scene.frame, &scene.source, &PROJECTORS, with);
    assert!(drawn.report.complete, "{}", drawn.report.shortfall);
    assert_is_light(scene.name, &drawn.images);
    drawn
}

/// Neither NaN nor infinite nor negative, nor more than opaque.
fn assert_is_light(name: &str, images: &[ProjectorImage]) {
    let pixels = images.iter().flat_map(|image| image.rgba.as_chunks::<4>().0);
    for pixel in pixels {
        let is_light = pixel.iter().all(|n| n.is_finite() && *n >= 0.0) && pixel[3] <= 1.0 + 1e-5;
        assert!(is_light, "{name}: {pixel:?} is no light");
    }
}

#[test]
fn kernel_and_twin_tell_the_same_picture() {
    let _turn = draw::turn();
    if !draw::has_gpu() {
        return;
    }
    let display = test_display();
    for base in techniques::bases(&display) {
        let plain = draw_on(&display, &base, DeviceChoice::Cpu);
        for (name, _) in TECHNIQUES {
            let scene = techniques::with(&base, name);
            let twin = draw_on(&display, &scene, DeviceChoice::Cpu);
            let kernel = draw_on(&display, &scene, DeviceChoice::Gpu);
            let errors = errors_between(&kernel.images, &twin.images);
            let effect = errors_between(&twin.images, &plain.images);
            println!("{:10} {name:40} {errors}; it changes {:.2} RMS", base.name, effect.rms * 255.0);
            assert!(SAME_TO_ROUNDING.hold(&errors), "{}, {name}: {errors}", base.name);
            assert!(!SAME_TO_ROUNDING.hold(&effect), "{}, {name} changes nothing", base.name);
        }
    }
}

#[test]
fn the_reference_tells_the_same_picture() {
    let _turn = draw::turn();
    let display = test_display();
    for base in techniques::bases(&display) {
        for (name, _) in TECHNIQUES {
            let scene = techniques::with(&base, name);
            let truth = compare::truth(&display, &scene.frame, &scene.source, &PROJECTORS, 4);
            let drawn = draw_on(&display, &scene, DeviceChoice::Cpu);
            let errors = compare::errors(&drawn.images, &truth);
            println!("{:10} {name:40} {errors}", base.name);
        }
    }
}
