//! How soon a back-end under a launcher shows again whose renderer is ended from outside, and what is left behind.
//!
//! `cargo run --release -p lightloom-tests --example comeback -- [--kills N | --for SECONDS]`

use lightloom_tests::comeback::{BACKENDS, COMES_BACK_WITHIN, Comeback, RATE_HZ, Show};
use lightloom_tests::processes::{children, open_files, resident_mib};
use lightloom_tests::program::LIMIT;
use lightloom_tests::random::Random;
use lightloom_tests::results::{Program, Results};
use serde_json::Value;
use std::thread::sleep;
use std::time::{Duration, Instant};

const KILLS: u32 = 100;

/// What ends a renderer, or has it hang.
const SIGNALS: [(&str, &str); 4] = [
    ("KILL", "killed, as for memory (SIGKILL)"),
    ("ABRT", "aborted, as by a panic of another thread (SIGABRT)"),
    ("SEGV", "a fault, as of a driver (SIGSEGV)"),
    ("STOP", "hangs (SIGSTOP)"),
];

const SEED: u64 = 2026;

/// The longest time between a comeback and the next end, milliseconds.
const LONGEST_REST_MS: u64 = 2000;

/// What a kill takes of the show's time, at most on average; a hang takes longer.
const SECONDS_PER_KILL: u32 = 3;

/// The show's own beginning, and its end, after the last comeback that is waited for, seconds.
const MARGIN: u32 = 30;

/// What the machine has to hold for a show.
struct Held {
    frontend: u32,
    keepers: Vec<u32>,
    processes: usize,
}

impl Held {
    fn of(show: &Show) -> Self {
        let kept = show.renderers();
        let mut keepers: Vec<u32> = kept.iter().map(|kept| kept.keeper).collect();
        keepers.dedup();
        let ranks = children(show.launcher());
        let processes = ranks.len() + ranks.iter().map(|&rank| children(rank).len()).sum::<usize>();
        Self { frontend: show.frontend(), keepers, processes }
    }

    fn row(&self, when: &str) -> String {
        let (files, mib) = (open_files(self.frontend), resident_mib(self.frontend));
        let of_keepers: Vec<String> =
            self.keepers.iter().map(|&keeper| open_files(keeper).to_string()).collect();
        let memory: Vec<String> =
            self.keepers.iter().map(|&keeper| format!("{:.1}", resident_mib(keeper))).collect();
        format!(
            "| {when} | {} | {files} | {} | {mib:.1} | {} |",
            self.processes,
            of_keepers.join(", "),
            memory.join(", ")
        )
    }
}

fn quantiles(times: impl Iterator<Item = Duration>) -> String {
    let mut ms: Vec<f64> = times.map(|time| time.as_secs_f64() * 1e3).collect();
    ms.sort_by(f64::total_cmp);
    let at = |share: f64| {
        ms.get(((share * ms.len() as f64).ceil() as usize).max(1) - 1).copied().unwrap_or(f64::NAN)
    };
    format!("{:.0} / {:.0} / {:.0}", at(0.5), at(0.99), at(1.0))
}

fn periods(time: Duration) -> f64 {
    time.as_secs_f64() * RATE_HZ
}

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let number = |text: Option<String>| text.and_then(|text| text.parse().ok()).ok_or("give a number");
    let for_kills = |kills| ("kills", kills, kills * SECONDS_PER_KILL + MARGIN);
    let (part, kills, seconds) = match (arguments.next().as_deref(), arguments.next()) {
        (None, _) => for_kills(KILLS),
        (Some("--kills"), kills) => for_kills(number(kills)?),
        (Some("--for"), seconds) => ("soak", u32::MAX, number(seconds)?),
        _ => return Err("give nothing, --kills N or --for SECONDS".to_owned()),
    };
    let Some(show) = Show::begin(seconds) else { return Ok(()) };
    let before = Held::of(&show).row("at the beginning");
    let last_kill =
        Duration::from_secs(seconds.into()).saturating_sub(COMES_BACK_WITHIN + Duration::from_secs(4));
    let (comebacks, missing, began) = end_one_after_another(&show, kills, last_kill);
    let after = Held::of(&show).row("at the end");
    let ran = show.finish(Duration::from_secs(seconds.into()) + LIMIT);
    if ran.code != Some(0) {
        return Err(ran.stderr);
    }
    let report: Value = serde_json::from_str(&ran.stdout).map_err(|error| error.to_string())?;
    let results = Results::new(Program::Study("comeback"), "comeback", part);
    tell(results, &comebacks, missing, began, [before, after], &report)
}

type Comebacks = Vec<(usize, Comeback)>;

/// Ends renderers at random until there were enough, or it is too late: who came back, how many did not, and how long that
/// took.
fn end_one_after_another(show: &Show, kills: u32, last_kill: Duration) -> (Comebacks, u32, Duration) {
    let (mut random, since) = (Random(SEED), Instant::now());
    let (mut comebacks, mut missing, mut newest) = (Vec::new(), 0, 0);
    while comebacks.len() as u32 + missing < kills && show.age() < last_kill {
        sleep(Duration::from_millis(random.below(LONGEST_REST_MS)));
        let (backend, signal) =
            (random.below(BACKENDS.into()) as u32, random.below(SIGNALS.len() as u64) as usize);
        newest = show.newest(newest).unwrap_or(newest);
        show.forget_before(newest.saturating_sub(5));
        let victim = show.renderers().into_iter().find(|kept| kept.backend == backend);
        match victim.and_then(|victim| show.end(victim, SIGNALS[signal].0, newest)) {
            Some(comeback) => comebacks.push((signal, comeback)),
            None => {
                eprintln!("back-end {backend} has not come back from SIG{}: {victim:?}", SIGNALS[signal].0);
                missing += 1;
            }
        }
    }
    (comebacks, missing, since.elapsed())
}

fn tell(
    mut results: Results,
    comebacks: &[(usize, Comeback)],
    missing: u32,
    took: Duration,
    held: [String; 2],
    report: &Value,
) -> Result<(), String> {
    let beat = &report["beat"];
    let late = |name: &str| -> u64 {
        let of = beat["backends"].as_array().into_iter().flatten().filter_map(|one| one[name].as_u64());
        of.sum()
    };
    results.line(format!(
        "{} ends in {:.0} s of a show of {} frames at {RATE_HZ} a second, seed {SEED}; {missing} did not come back. The \
         front-end counted {} losses, and {} frames that were shown without one of the back-ends that it had not lost.\n",
        comebacks.len() as u32 + missing,
        took.as_secs_f64(),
        beat["frames"],
        late("lost"),
        late("late"),
    ));
    results.line("| a renderer is | times | until it shows again, ms | until it shows the complete picture, ms | the others waited at most, periods of 50 ms |");
    results.line("| --- | ---: | ---: | ---: | ---: |");
    let mut row = |name: &str, of: Vec<&Comeback>| {
        let mut each: Vec<f64> = of.iter().map(|one| periods(one.others_late)).collect();
        each.sort_by(f64::total_cmp);
        let [median, most] = [each.len() / 2, each.len().saturating_sub(1)]
            .map(|place| each.get(place).copied().unwrap_or_default());
        results.line(format!(
            "| {name} | {} | {} | {} | {median:.1}, at most {most:.1} |",
            of.len(),
            quantiles(of.iter().map(|one| one.shown)),
            quantiles(of.iter().map(|one| one.right)),
        ));
    };
    for (number, (_, name)) in SIGNALS.iter().enumerate() {
        row(name, comebacks.iter().filter(|one| one.0 == number).map(|one| &one.1).collect());
    }
    row(
        "any but hanging",
        comebacks.iter().filter(|one| SIGNALS[one.0].0 != "STOP").map(|one| &one.1).collect(),
    );
    results.line("\n| | processes | files of the front-end | files of the keepers | memory of the front-end, MiB | memory of the keepers, MiB |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: |");
    held.iter().for_each(|row| results.line(row));
    results.finish()
}
