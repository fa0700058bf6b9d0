//! The pages in `tests/results`: benches and studies print their figures, and write them there if asked to.
//!
//! `LIGHTLOOM_RESULTS=1` writes to that folder, `LIGHTLOOM_RESULTS=DIR` to another; without it, a run only prints. Each
//! page has marked parts, one for each kind of run. A run replaces its own part and leaves the rest, which people write.

use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// How the variables begin that change what is measured.
const CHANGES_FIGURES: [&str; 3] = ["LIGHTLOOM_BENCH_", "LIGHTLOOM_FULL_SIZE", "LIGHTLOOM_RANDOM_"];

const SECONDS_PER_DAY: u64 = 24 * 60 * 60;

/// What kind of program measures, and its name.
#[derive(Clone, Copy, Debug)]
pub enum Program {
    /// A bench of this crate.
    Bench(&'static str),
    /// A study of this crate.
    Study(&'static str),
    /// A program of tests of this crate, whose figures are kept at full size.
    Tests(&'static str),
}

impl Program {
    /// The command that starts it, without its variables and arguments.
    fn command(self) -> String {
        match self {
            Self::Bench(name) => format!("cargo bench -p lightloom-tests --bench {name}"),
            Self::Study(name) => format!("cargo run --release -p lightloom-tests --example {name}"),
            Self::Tests(name) => format!("cargo test --release -p lightloom-tests --test {name}"),
        }
    }
}

/// One part of a page, as it grows.
#[derive(Debug)]
pub struct Results {
    program: Program,
    page: &'static str,
    part: &'static str,
    adapters: Vec<String>,
    text: String,
}

impl Results {
    /// The part of `page`, which has no extension, that `program` is about to measure.
    pub fn new(program: Program, page: &'static str, part: &'static str) -> Self {
        Self { program, page, part, adapters: Vec::new(), text: String::new() }
    }

    /// Adds a line of Markdown, and prints it at once.
    pub fn line(&mut self, line: impl Display) {
        println!("{line}");
        self.text += &format!("{line}\n");
    }

    /// Notes what drew, for the account of the machine.
    pub fn drawn_by(&mut self, adapter: &str) {
        if !self.adapters.iter().any(|known| known == adapter) {
            self.adapters.push(adapter.to_owned());
        }
    }

    /// Writes the part into its page if the environment asks for it.
    pub fn finish(self) -> Result<(), String> {
        let Some(folder) = folder() else { return Ok(()) };
        let path = folder.join(self.page).with_extension("md");
        let old = fs::read_to_string(&path).unwrap_or_else(|_| format!("# {}\n", self.page));
        let body = format!("{}\n\n{}", self.account(), self.text.trim());
        let write = || {
            fs::create_dir_all(&folder)?;
            fs::write(&path, replaced(&old, self.part, &body))
        };
        write().map_err(|error| format!("{}: {error}", path.display()))?;
        println!("\nwritten to {}", path.display());
        Ok(())
    }

    /// When, where and how this was measured.
    fn account(&self) -> String {
        let arguments = std::env::args().skip(1).filter(|argument| argument != "--bench");
        let command = command_line(self.program, std::env::vars(), arguments);
        let (commit, machine) = (commit(), machine(&self.adapters));
        let since_epoch = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        format!("*Measured at commit {commit} on {}, on {machine}, by* `{command}`", date(since_epoch))
    }
}

/// The folder to write to; None if a run only prints.
pub fn folder() -> Option<PathBuf> {
    match std::env::var("LIGHTLOOM_RESULTS").ok()?.as_str() {
        "" | "0" => None,
        "1" => Some(Path::new(env!("CARGO_MANIFEST_DIR")).join("results")),
        folder => Some(PathBuf::from(folder)),
    }
}

/// A page with a part replaced, or added at its end.
fn replaced(page: &str, part: &str, body: &str) -> String {
    let (begin, end) = (format!("<!-- written by the command: {part} -->"), format!("<!-- end: {part} -->"));
    let marked = format!("{begin}\n\n{body}\n\n{end}");
    let place = page.find(&begin).and_then(|at| Some((at, at + page[at..].find(&end)? + end.len())));
    match place {
        Some((from, to)) => format!("{}{marked}{}", &page[..from], &page[to..]),
        None => format!("{}\n\n{marked}\n", page.trim_end()),
    }
}

/// The command with the variables that change what it measures, and its arguments.
fn command_line(
    program: Program,
    variables: impl Iterator<Item = (String, String)>,
    arguments: impl Iterator<Item = String>,
) -> String {
    let mut words: Vec<String> = variables
        .filter(|(name, _)| {
            CHANGES_FIGURES.iter().any(|begin| name.starts_with(begin)) && !name.ends_with("_DIR")
        })
        .map(|(name, value)| format!("{name}={value}"))
        .collect();
    words.sort();
    words.push(program.command());
    let arguments: Vec<String> = arguments.collect();
    if !arguments.is_empty() {
        words.push("--".to_owned());
    }
    words.extend(arguments);
    words.join(" ")
}

/// What git prints; None if it fails.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The commit, with `-dirty` if more than results differ from it.
fn commit() -> String {
    let Some(commit) = git(&["rev-parse", "--short", "HEAD"]) else { return "unknown".to_owned() };
    let is_clean = git(&["diff", "--quiet", "HEAD", "--", ":/", ":!/tests/results"]).is_some();
    if is_clean { commit } else { commit + "-dirty" }
}

/// The processor, its cores, and what drew.
fn machine(adapters: &[String]) -> String {
    let about = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = about.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let name = name.map_or("an unknown processor", |(_, name)| name.trim());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let adapters: String = adapters.iter().map(|adapter| format!(", {adapter}")).collect();
    format!("{name}, {cores} cores{adapters}")
}

/// Year, month and day (UTC) of a time since 1970-01-01; the days of a year count from 1 March, so that a leap day is
/// the last.
fn date(since_epoch: Duration) -> String {
    let days = since_epoch.as_secs() / SECONDS_PER_DAY + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_replaced_and_the_rest_stays() {
        let page = replaced(&replaced("# Page\n\nWords.\n", "a", "old a"), "b", "old b");
        let changed = replaced(&page, "a", "new a");
        assert!(changed.contains("Words.") && changed.contains("old b"), "{changed}");
        assert!(changed.contains("new a") && !changed.contains("old a"), "{changed}");
        assert_eq!(replaced(&changed, "a", "new a"), changed);
    }

    #[test]
    fn the_command_has_its_variables_and_arguments() {
        let variables = [("LIGHTLOOM_BENCH_VIEWS", "8"), ("HOME", "/"), ("LIGHTLOOM_BENCH_DIR", "/tmp")];
        let variables = variables.map(|(name, value)| (name.to_owned(), value.to_owned()));
        let command = command_line(Program::Study("s"), variables.into_iter(), ["-x".to_owned()].into_iter());
        let expected = "LIGHTLOOM_BENCH_VIEWS=8 cargo run --release -p lightloom-tests --example s -- -x";
        assert_eq!(command, expected);
    }

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (days, expected) in [(0, "1970-01-01"), (11_016, "2000-02-29"), (20_779, "2026-11-22")] {
            assert_eq!(date(Duration::from_secs(days * SECONDS_PER_DAY + 7)), expected);
        }
    }
}
