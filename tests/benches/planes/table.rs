//! Both casters at the default quality.

use crate::measure::{measure, number, renderer};
use crate::scene::{COMPARED, Scene};
use crate::sweep;
use lightloom_tests::compare;
use lightloom_tests::memory::peak_mib;
use lightloom_tests::results::{Program, Results};
use protocol::CasterChoice;

/// Planes of the competitor.
const SWEPT: [usize; 2] = [256, 1024];

pub fn run(scenes: &[Scene]) -> Result<(), String> {
    let ray_views = number("LIGHTLOOM_BENCH_RAY_VIEWS", 3).min(72);
    let mut results = Results::new(Program::Bench("planes"), "planes", "cpu");
    results.line("| scene | caster | views | seconds | Gsamples | RMS, 99.9 %, largest error of 255 | bricks | peak MiB |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for scene in scenes {
        let all: Vec<u32> = (0..72).collect();
        let others = (0..72).step_by(4).filter(|p| !COMPARED.contains(p));
        let few: Vec<u32> = COMPARED.into_iter().chain(others).take(ray_views).collect();
        for (caster, projectors) in [(CasterChoice::Planes, &all), (CasterChoice::Rays, &few)] {
            if projectors.is_empty() {
                continue;
            }
            let (mut renderer, adapter) = renderer(scene, caster, projectors);
            results.drawn_by(&adapter);
            let found = measure(&mut renderer, &scene.frame, scene.truth());
            results.line(format!(
                "| {} | {caster:?} | {} | {:.2} | {:.2} | {} | {} | {:.0} |",
                scene.name,
                projectors.len(),
                found.seconds,
                found.report.samples as f64 / 1e9,
                found.codes(),
                found.report.working_set_union,
                peak_mib(),
            ));
        }
        for count in SWEPT.into_iter().filter(|_| sweep::can_draw(scene)) {
            let found = sweep::sweep(scene, count);
            results.line(format!(
                "| {} | plane sweep, {count} planes | 72 | {:.2} | {:.2} | {} | {} | {:.0} |",
                scene.name,
                found.seconds,
                found.samples as f64 / 1e9,
                compare::codes(&found.errors),
                found.bricks,
                peak_mib(),
            ));
        }
    }
    results.finish()
}
