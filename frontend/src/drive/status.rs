//! A line on the terminal that says how the display is doing.

use super::BeatSummary;
use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// How often the line changes.
const INTERVAL: Duration = Duration::from_millis(500);

/// The line, on standard error, where that is a terminal.
pub struct Status {
    bar: Option<ProgressBar>,
    told_at: Option<Duration>,
}

impl Status {
    /// No line yet; with `is_shown` false there never is one.
    pub fn new(is_shown: bool) -> Self {
        let bar = is_shown.then(|| {
            let style = ProgressStyle::with_template("{elapsed_precise}  {msg}");
            ProgressBar::no_length().with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Self { bar, told_at: None }
    }

    /// Tells it, if it is time to; `summary` is asked for only then.
    pub fn tell(&mut self, now: Duration, what: &str, summary: impl FnOnce() -> BeatSummary) {
        let Some(bar) = &self.bar else { return };
        if self.told_at.is_some_and(|before| now < before + INTERVAL) {
            return;
        }
        self.told_at = Some(now);
        let summary = summary();
        let rate_hz = 1e3 / summary.interval_ms.p50.max(1e-3);
        let late: u64 = summary.backends.iter().map(|backend| backend.late).sum();
        bar.set_message(format!(
            "{} frames, {rate_hz:.1} a second, {:.0} ms from input to screen, skew {:.2} ms, {late} late{what}",
            summary.frames, summary.input_to_shown_ms.p50, summary.skew_ms.p99,
        ));
        bar.tick();
    }
}

impl Drop for Status {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
