//! How a study is stopped, and reports how far it is.

use super::AccuracyError;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;

/// What long work checks and reports to. It may be asked from many threads at once.
#[derive(Clone)]
pub struct Watch {
    stop: Arc<AtomicBool>,
    news: Sender<News>,
}

/// The part of the work that is done, 0 to 1, and what is being done.
pub(super) type News = (f64, String);

impl Watch {
    /// A watch that `stop` ends, and that reports to the other end of `news`.
    pub(super) fn new(stop: Arc<AtomicBool>, news: Sender<News>) -> Self {
        Self { stop, news }
    }

    /// An error once the work is to end.
    pub fn check(&self) -> Result<(), AccuracyError> {
        if self.stop.load(Ordering::Relaxed) { Err(AccuracyError::Stopped) } else { Ok(()) }
    }

    /// `part` of the work, 0 to 1, is done; `what` is being done.
    pub fn tell(&self, part: f64, what: &str) {
        // Whoever does not listen any more does not want to know.
        let _ = self.news.send((part, what.to_owned()));
    }
}
