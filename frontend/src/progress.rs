//! A progress bar for long work.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// Shorter work shows no bar.
const PATIENCE: Duration = Duration::from_secs(2);
/// Steps of a bar: it shows parts of the whole.
const STEPS: u64 = 10_000;

/// A bar on standard error that appears after two seconds, and only on a terminal.
pub struct Progress {
    started: Instant,
    is_shown: bool,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// No bar yet; with `is_shown` false there never is one.
    pub fn new(is_shown: bool) -> Self {
        Self { started: Instant::now(), is_shown, bar: None }
    }

    /// `part` of the work, from 0 to 1, is done; `what` is being done.
    pub fn set(&mut self, part: f64, what: &str) {
        if self.bar.is_none() && self.is_shown && self.started.elapsed() >= PATIENCE {
            self.bar = Some(new_bar());
        }
        if let Some(bar) = &self.bar {
            bar.set_position((part.clamp(0.0, 1.0) * STEPS as f64) as u64);
            if bar.message() != what {
                bar.set_message(what.to_owned());
            }
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn new_bar() -> ProgressBar {
    let style = ProgressStyle::with_template(
        "{elapsed_precise} {bar:40.cyan/blue} {percent:>3} %  {msg}  (ends in {eta})",
    );
    let bar = ProgressBar::new(STEPS);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
