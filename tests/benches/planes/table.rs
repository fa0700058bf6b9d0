//! Both casters at the default quality.

use crate::measure::{COMPARED, codes, measure, number, renderer, truth};
use crate::scene::wanted;
use lightloom_tests::memory::peak_mib;
use lightloom_tests::results::{Program, Results};
use protocol::CasterChoice;
use std::path::Path;

pub fn run(folder: &Path) -> Result<(), String> {
    let ray_views = number("LIGHTLOOM_BENCH_RAY_VIEWS", 3).min(72);
    let mut results = Results::new(Program::Bench("planes"), "planes", "cpu");
    results.line("| scene | caster | views | seconds | Gsamples | RMS, 99.9 %, largest error of 255 | bricks | peak MiB |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for scene in wanted(folder) {
        let truth = truth(&scene);
        let all: Vec<u32> = (0..72).collect();
        let others = (0..72).step_by(4).filter(|p| !COMPARED.contains(p));
        let few: Vec<u32> = COMPARED.into_iter().chain(others).take(ray_views).collect();
        for (caster, projectors) in [(CasterChoice::Planes, &all), (CasterChoice::Rays, &few)] {
            if projectors.is_empty() {
                continue;
            }
            let (mut renderer, adapter) = renderer(&scene, caster, projectors);
            results.drawn_by(&adapter);
            let found = measure(&mut renderer, &scene.frame, &truth);
            results.line(format!(
                "| {} | {caster:?} | {} | {:.2} | {:.2} | {} | {} | {:.0} |",
                scene.name,
                projectors.len(),
                found.seconds,
                found.report.samples as f64 / 1e9,
                codes(&found.errors),
                found.report.working_set_union,
                peak_mib(),
            ));
        }
    }
    results.finish()
}
