//! `lightloom inputs`.

use super::say::{print, say};
use crate::cli::InputsArgs;
use crate::monitor::{InputsReport, Meter, table};
use crate::{FrontendError, interrupt};
use inputs::{Hub, Input};
use std::io::IsTerminal;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// How often sources are asked.
const ASKED: Duration = Duration::from_millis(10);
/// How often the table on a terminal changes.
const REDRAWN: Duration = Duration::from_millis(500);

/// Shows what arrives from the sources of a file until somebody ends it, and a report of it then.
pub(super) fn inputs(args: &InputsArgs) -> Result<(), FrontendError> {
    let inputs = Input::load(&args.file)?;
    let stop = interrupt::stop_flag()?;
    let (mut hub, mut meter) = (Hub::start(&inputs)?, Meter::new(&inputs));
    let mut screen = Screen::new(args.json);
    let began = Instant::now();
    let (mut events, mut redrawn) = (Vec::new(), Duration::ZERO);
    while !stop.load(Ordering::SeqCst) && args.time.is_none_or(|time| began.elapsed() < time) {
        std::thread::sleep(ASKED);
        let now = began.elapsed();
        hub.poll(now, &mut events);
        for sentence in events.drain(..).filter_map(|event| meter.add(&event)) {
            screen.tell(&sentence)?;
        }
        if now >= redrawn + REDRAWN {
            screen.draw(|| meter.lap(now, hub.counts()))?;
            redrawn = now;
        }
    }
    screen.clear()?;
    let report = meter.report(began.elapsed(), hub.counts());
    match args.json {
        true => say(&serde_json::to_string_pretty(&report)?),
        false => say(&table(&report)),
    }
}

/// What is shown until the report.
enum Screen {
    /// Nothing.
    Silent,
    /// Sentences.
    Plain,
    /// Sentences above a table of so many lines, which is drawn over itself.
    Terminal { lines: usize },
}

impl Screen {
    fn new(is_silent: bool) -> Self {
        match (is_silent, std::io::stdout().is_terminal()) {
            (true, _) => Self::Silent,
            (false, false) => Self::Plain,
            (false, true) => Self::Terminal { lines: 0 },
        }
    }

    fn tell(&mut self, sentence: &str) -> Result<(), FrontendError> {
        self.clear()?;
        if matches!(self, Self::Silent) { Ok(()) } else { say(sentence) }
    }

    /// Takes the table away, so that something else stands in its place.
    fn clear(&mut self) -> Result<(), FrontendError> {
        match self {
            Self::Terminal { lines } if *lines > 0 => {
                // Up by so many lines, and clear from there on.
                let up = std::mem::take(lines);
                print(&format!("\x1b[{up}A\x1b[J"))
            }
            _ => Ok(()),
        }
    }

    fn draw(&mut self, report: impl FnOnce() -> InputsReport) -> Result<(), FrontendError> {
        self.clear()?;
        let Self::Terminal { lines } = self else { return Ok(()) };
        let table = table(&report());
        *lines = table.lines().count();
        // Lines that are too long for the terminal are cut, not wrapped: their number has to be right.
        say(&format!("\x1b[?7l{table}\x1b[?7h"))
    }
}
