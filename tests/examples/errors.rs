//! Prints the errors of the test scenes against the reference, and the time they take, at several settings.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example errors -- [SCENE] [--gpu] [--no-light]
//! ```
//!
//! SCENE: only scenes whose name contains it; all without it. `--gpu`: by the GPU instead of the CPU. `--no-light`: without
//! shading, which tells the errors of shading from those of compositing.

use backend::protocol::DeviceChoice;
use display_config::Display;
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::{compare, draw};
use std::time::Instant;

/// Longest step in voxels, and error allowed per step.
const SETTINGS: [(f64, f64); 6] =
    [(1.0, 5e-5), (0.75, 1e-4), (0.5, 2.5e-4), (0.5, 1e-4), (0.4, 1e-4), (0.33, 1e-4)];
/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];

struct Arguments {
    scene: String,
    device: DeviceChoice,
    has_light: bool,
}

fn arguments() -> Result<Arguments, String> {
    let mut found = Arguments { scene: String::new(), device: DeviceChoice::Cpu, has_light: true };
    for argument in std::env::args().skip(1) {
        match argument.as_str() {
            "--gpu" => found.device = DeviceChoice::Gpu,
            "--no-light" => found.has_light = false,
            name if !name.starts_with('-') => found.scene = name.into(),
            other => return Err(format!("`{other}` is unknown; give [SCENE] [--gpu] [--no-light]")),
        }
    }
    Ok(found)
}

fn table(display: &Display, scene: &TestScene, device: DeviceChoice) {
    let started = Instant::now();
    let truth = compare::truth(display, &scene.frame, &scene.source, &PROJECTORS, 1);
    println!("{}: reference {:.1} s", scene.name, started.elapsed().as_secs_f64());
    for (step_voxels, tolerance) in SETTINGS {
        let mut frame = scene.frame.clone();
        (frame.quality.step_voxels, frame.quality.tolerance) = (step_voxels, tolerance);
        let drawn = draw::draw(display, &frame, &scene.source, &PROJECTORS, draw::With::device(device));
        println!(
            "  step {step_voxels:4} tolerance {tolerance:.1e}: {}   cast {:.0} ms, {:.1} million samples per second",
            compare::errors(&drawn.images, &truth),
            drawn.report.stages.cast_ms,
            drawn.report.samples as f64 / drawn.report.stages.cast_ms / 1e3
        );
    }
}

fn main() -> Result<(), String> {
    let Arguments { scene: name, device, has_light } = arguments()?;
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    for mut scene in scenes::all(&display).into_iter().filter(|scene| scene.name.contains(&name)) {
        if !has_light {
            scene.frame.light = None;
        }
        table(&display, &scene, device);
    }
    Ok(())
}
