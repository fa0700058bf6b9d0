//! What a display at rest takes of the processors: the program itself, all of its processes, over a minute.

use super::{PAGE, PROGRAM};
use lightloom_tests::processes::{children, ticks};
use lightloom_tests::program::{cluster, lightloom, start};
use lightloom_tests::results::Results;
use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// From the start until the pictures are complete and nothing is under way, with time to spare.
const SETTLING: Duration = Duration::from_secs(20);
const MEASURED: Duration = Duration::from_secs(60);
/// The program goes on for so long after that.
const REST: Duration = Duration::from_secs(5);
const BACKENDS: u32 = 4;
const TICKS_PER_S: f64 = 100.0;

pub fn measure() -> Result<(), String> {
    let mut results = Results::new(PROGRAM, PAGE, "rest");
    results.line("| cast by | processes | of a core, all of them | of a core, the busiest | processor time in a minute | periods in which nothing was cast |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: |");
    for caster in ["rays", "planes"] {
        let seconds = (SETTLING + MEASURED + REST).as_secs().to_string();
        let arguments = [
            "drive",
            "procedural:shells@128",
            "--display",
            "desk8",
            "--output",
            "none",
            "--device",
            "cpu",
            "--caster",
            caster,
            "--control",
            "errors",
            "--for",
            &seconds,
            "--json",
        ];
        row(&mut results, caster, "one", &mut lightloom(&arguments))?;
        if let Some(mut command) = cluster(&arguments, BACKENDS) {
            row(
                &mut results,
                caster,
                "mpirun, front-end and 4 back-ends, each with its keeper",
                &mut command,
            )?;
        }
    }
    results.finish()
}

/// Runs a show and tells what it took while it was at rest.
fn row(results: &mut Results, caster: &str, what: &str, command: &mut Command) -> Result<(), String> {
    let running = start(command);
    sleep(SETTLING);
    let (before, began) = (used(running.process()), Instant::now());
    sleep(MEASURED);
    let (after, seconds) = (used(running.process()), began.elapsed().as_secs_f64());
    let ran = running.finish(2 * (SETTLING + MEASURED + REST));
    if ran.code != Some(0) {
        return Err(ran.stderr);
    }
    if !before.keys().eq(after.keys()) {
        return Err(format!("processes came or went: {:?} and {:?}", before.keys(), after.keys()));
    }
    let report: Value = serde_json::from_str(&ran.stdout).map_err(|error| error.to_string())?;
    let took: Vec<f64> = after.iter().map(|(process, ticks)| (ticks - before[process]) as f64).collect();
    let of_a_core = |ticks: f64| 100.0 * ticks / TICKS_PER_S / seconds;
    let (all, busiest) = (took.iter().sum::<f64>(), took.iter().copied().fold(0.0, f64::max));
    let count = if took.len() > 1 { format!("{}: {what}", took.len()) } else { what.to_owned() };
    results.line(format!(
        "| {caster} | {count} | {:.2} % | {:.2} % | {:.2} s | {:.1} % |",
        of_a_core(all),
        of_a_core(busiest),
        all / TICKS_PER_S,
        100.0 * report["control"]["idle_share"].as_f64().unwrap_or(f64::NAN),
    ));
    Ok(())
}

/// What a process and all below it have used of the processors until now, each by its number.
fn used(process: u32) -> BTreeMap<u32, u64> {
    let mut used = BTreeMap::new();
    let mut waiting = vec![process];
    while let Some(process) = waiting.pop() {
        used.insert(process, ticks(process));
        waiting.extend(children(process));
    }
    used
}
