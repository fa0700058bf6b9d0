//! Errors of every test scene at several steps: a look, not a test.
use backend::protocol::DeviceChoice;
use display_config::Display;
use lightloom_tests::{compare, draw, scenes};
const SETTINGS: [(f64, f64); 2] = [(0.4, 1e-4), (0.5, 1e-4)];

fn main() {
    let display = Display::load("desk8").expect("a preset");
    let only = std::env::args().nth(1);
    let unlit = std::env::args().nth(2).is_some();
    for mut scene in scenes::all(&display) {
        if unlit {
            scene.frame.light = None;
        }
        if only.as_ref().is_some_and(|o| !scene.name.contains(o.as_str())) {
            continue;
        }
        let projectors = [1, 5];
        let started = std::time::Instant::now();
        let truth = compare::truth(&display, &scene.frame, &scene.source, &projectors, 1);
        println!("{}: reference {:.1} s", scene.name, started.elapsed().as_secs_f64());
        for (step, tolerance) in SETTINGS {
            let mut frame = scene.frame.clone();
            frame.quality.step_voxels = step;
            frame.quality.tolerance = tolerance;
            let drawn = draw::draw(
                &display,
                &frame,
                &scene.source,
                &projectors,
                draw::With::device(DeviceChoice::Cpu),
            );
            println!(
                "  step {step} tolerance {tolerance:.1e}: {}   cast {:.0} ms, {:.1} Msamples/s",
                compare::errors(&drawn.images, &truth),
                drawn.report.stages.cast_ms,
                drawn.report.samples as f64 / drawn.report.stages.cast_ms / 1e3
            );
        }
    }
}
