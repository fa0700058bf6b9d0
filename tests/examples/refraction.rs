//! What bent light errs and costs, by the tolerance that it is asked for: the CPU device against the reference.
//!
//! `cargo run --release -p lightloom-tests --example refraction`. Pixels whose truth the reference does not reach are
//! counted, and compared with what it has.

use display_config::Display;
use lightloom_tests::compare;
use lightloom_tests::draw::{With, renderer};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::techniques;
use protocol::{DeviceChoice, FilterChoice};

const PROJECTORS: [u32; 2] = [1, 5];
const TOLERANCES: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];
const STRIDE: u32 = 4;

fn main() -> Result<(), String> {
    let display = Display::load("desk8").expect("a preset").with_rasters(160, 120);
    let mut results = Results::new(Program::Study("refraction"), "refraction", "tolerance");
    results.line("| scene | tolerance | samples per ray | seconds | RMS | 99.9 % | largest | not reached |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for base in techniques::bases(&display) {
        let mut scene = techniques::with(&base, "refraction");
        let truth = compare::traced(&display, &scene.frame, &scene.source, &PROJECTORS, STRIDE);
        let missed = truth.iter().filter(|pixel| !pixel.truth.reached).count();
        for tolerance in TOLERANCES {
            scene.frame.quality.tolerance = tolerance;
            let with = With { filter: FilterChoice::Exact, ..With::device(DeviceChoice::Cpu) };
            let (mut renderer, _) = renderer(&display, &scene.source, &PROJECTORS, with);
            let began = std::time::Instant::now();
            let (images, report) = lightloom_tests::draw::draw_with(&mut renderer, &scene.frame);
            let seconds = began.elapsed().as_secs_f64();
            let errors = compare::errors(&images, &truth);
            let per_ray = report.samples as f64 / report.rays as f64;
            results.line(format!(
                "| {} | {tolerance:e} | {per_ray:.1} | {seconds:.2} | {:.3} | {:.2} | {:.1} | {missed} of {} |",
                base.name,
                255.0 * errors.rms,
                255.0 * errors.p999,
                255.0 * errors.max,
                truth.len()
            ));
        }
    }
    results.finish()
}
