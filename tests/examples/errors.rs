//! Prints the errors of the test scenes against the reference, and the time they take, at several settings.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example errors -- [SCENE] [--gpu] [--no-light] [--with TECHNIQUE]
//! ```
//!
//! SCENE: only scenes whose name contains it; all without it. `--gpu`: by the GPU instead of the CPU. `--no-light`: without
//! shading, which tells the errors of shading from those of compositing. `--with`: with one of the illustrative techniques.

use display_config::Display;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques::{self, TECHNIQUES};
use lightloom_tests::{compare, draw};
use protocol::DeviceChoice;
use std::time::Instant;

/// Longest step in voxels, and error allowed per step.
const SETTINGS: [(f64, f64); 8] = [
    (0.025, 1e-5),
    (0.1, 1e-5),
    (1.0, 5e-5),
    (0.75, 1e-4),
    (0.5, 2.5e-4),
    (0.5, 1e-4),
    (0.4, 1e-4),
    (0.33, 1e-4),
];
/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// Pixels between those that are compared: the reference of bent light takes its time.
const STRIDE: u32 = 4;

struct Arguments {
    scene: String,
    device: DeviceChoice,
    has_light: bool,
    technique: Option<&'static str>,
}

fn arguments() -> Result<Arguments, String> {
    let mut found =
        Arguments { scene: String::new(), device: DeviceChoice::Cpu, has_light: true, technique: None };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--gpu" => found.device = DeviceChoice::Gpu,
            "--no-light" => found.has_light = false,
            "--with" => {
                let name = arguments.next().unwrap_or_default();
                let known = TECHNIQUES.iter().find(|(known, _)| *known == name).map(|(known, _)| *known);
                found.technique = Some(known.ok_or_else(|| format!("`{name}` is no technique"))?);
            }
            name if !name.starts_with('-') => found.scene = name.into(),
            other => {
                return Err(format!(
                    "`{other}` is unknown; give [SCENE] [--gpu] [--no-light] [--with TECHNIQUE]"
                ));
            }
        }
    }
    Ok(found)
}

fn table(results: &mut Results, display: &Display, scene: &TestScene, device: DeviceChoice) {
    let started = Instant::now();
    let truth = compare::traced(display, &scene.frame, &scene.source, &PROJECTORS, STRIDE);
    eprintln!("{}: reference {:.1} s", scene.name, started.elapsed().as_secs_f64());
    for (step_voxels, tolerance) in SETTINGS {
        let mut frame = scene.frame.clone();
        (frame.quality.step_voxels, frame.quality.tolerance) = (step_voxels, tolerance);
        let drawn = draw::draw(display, &frame, &scene.source, &PROJECTORS, draw::With::device(device));
        results.drawn_by(&drawn.info.adapter);
        let errors = compare::errors(&drawn.images, &truth);
        let [rms, p999, max] = [errors.rms, errors.p999, errors.max].map(|error| 255.0 * error);
        results.line(format!(
            "| {} | {step_voxels} | {tolerance:.1e} | {rms:.4} / {p999:.3} / {max:.2} | {:.0} | {:.1} |",
            scene.name,
            drawn.report.stages.cast_ms,
            drawn.report.samples as f64 / drawn.report.stages.cast_ms / 1e3
        ));
    }
}

fn main() -> Result<(), String> {
    let Arguments { scene: name, device, has_light, technique } = arguments()?;
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    let all = std::iter::once(techniques::bumps(&display)).chain(scenes::all(&display));
    let mut results = Results::new(Program::Study("errors"), "errors", "errors");
    results
        .line("| scene | step, voxels | tolerance | RMS / 99.9 % / largest of 255 | cast, ms | Msamples/s |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: |");
    for mut scene in all.filter(|scene| scene.name.contains(&name)) {
        if !has_light {
            scene.frame.light = None;
        }
        if let Some(technique) = technique {
            scene = techniques::with(&scene, technique);
        }
        table(&mut results, &display, &scene, device);
    }
    results.finish()
}
