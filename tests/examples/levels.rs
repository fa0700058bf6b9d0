//! Prints how far coarser levels are from the finest, with and without the standard deviations of what voxels stand for.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example levels
//! ```

use display_config::Display;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::{compare, draw};
use protocol::DeviceChoice;

/// Voxel edges over what the display resolves.
const SCALES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
const PROJECTORS: [u32; 2] = [1, 5];
const STRIDE: u32 = 3;

fn table(results: &mut Results, display: &Display, scene: &TestScene) {
    let mut finest = scene.frame.clone();
    finest.quality.lod_scale = 0.0;
    let truth = compare::traced(display, &finest, &scene.source, &PROJECTORS, STRIDE);
    for lod_scale in SCALES {
        let cells = [false, true].map(|deviation| {
            let mut frame = scene.frame.clone();
            (frame.quality.lod_scale, frame.quality.deviation) = (lod_scale, deviation);
            let with = draw::With::device(DeviceChoice::Cpu);
            let drawn = draw::draw(display, &frame, &scene.source, &PROJECTORS, with);
            results.drawn_by(&drawn.info.adapter);
            let errors = compare::errors(&drawn.images, &truth);
            let [rms, p999, max] = [errors.rms, errors.p999, errors.max].map(|error| 255.0 * error);
            format!("{rms:.2} / {p999:.1} / {max:.0} | {:.0}", drawn.report.stages.cast_ms)
        });
        results.line(format!("| {} | {lod_scale} | {} | {} |", scene.name, cells[0], cells[1]));
    }
}

fn main() -> Result<(), String> {
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    let display = display.with_rasters(160, 120);
    let mut results = Results::new(Program::Study("levels"), "levels", "levels");
    results.line(
        "| scene | `lod_scale` | means alone: RMS, 99.9 %, largest of 255 | ms | with deviations | ms |",
    );
    results.line("| --- | ---: | --- | ---: | --- | ---: |");
    let stored = [
        scenes::cranium(&display),
        scenes::head_mri(&display),
        Some(scenes::stored_vessels(&display)),
        Some(scenes::noise(&display)),
    ];
    for scene in stored.into_iter().flatten() {
        table(&mut results, &display, &scene);
    }
    results.finish()
}
