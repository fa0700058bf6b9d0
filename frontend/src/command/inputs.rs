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
    let mut hub = Hub::start(&inputs)?;
    let mut meter = Meter::new(&inputs);
    let mut screen = (!args.json && std::io::stdout().is_terminal()).then(Screen::default);
    let began = Instant::now();
    let (mut events, mut redrawn) = (Vec::new(), Duration::ZERO);
    loop {
        let now = began.elapsed();
        hub.poll(now, &mut events);
        for sentence in events.drain(..).filter_map(|event| meter.add(&event)) {
            screen.as_mut().map_or(Ok(()), Screen::clear)?;
            if !args.json {
                say(&sentence)?;
            }
        }
        if stop.load(Ordering::SeqCst) || args.time.is_some_and(|time| now >= time) {
            break;
        }
        if let Some(screen) = &mut screen
            && now >= redrawn + REDRAWN
        {
            screen.draw(&meter.lap(now, hub.counts()))?;
            redrawn = now;
        }
        std::thread::sleep(ASKED);
    }
    screen.as_mut().map_or(Ok(()), Screen::clear)?;
    let report = meter.report(began.elapsed(), hub.counts());
    match args.json {
        true => say(&serde_json::to_string_pretty(&report)?),
        false => say(&table(&report)),
    }
}

/// The table on a terminal, which is drawn over itself.
#[derive(Default)]
struct Screen {
    lines: usize,
}

impl Screen {
    /// Takes the table away, so that something else stands in its place.
    fn clear(&mut self) -> Result<(), FrontendError> {
        match std::mem::take(&mut self.lines) {
            0 => Ok(()),
            // Up by so many lines, and clear from there on.
            lines => print(&format!("\x1b[{lines}A\x1b[J")),
        }
    }

    fn draw(&mut self, report: &InputsReport) -> Result<(), FrontendError> {
        self.clear()?;
        let table = table(report);
        self.lines = table.lines().count();
        say(&table)
    }
}
