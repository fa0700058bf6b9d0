//! Where the thread of a source puts what it hears.

use crate::Refusal;
use crate::event::What;
use crate::queue::{Measured, Queue, Waiting};
use crate::reading::{Parts, Reading, Stamp};
use crate::state::State;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Clocks that differ by more are not in step, seconds: a few are bad time servers, 37 is a clock of atomic time.
const IN_STEP_S: f64 = 10.0;

/// How much a source has said.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Messages that arrived, whatever became of them.
    pub messages: u64,
    /// Messages, or parts of them, that were refused, by reason.
    pub refused: BTreeMap<Refusal, u64>,
    /// Events that were dropped, since nobody asked for them in time.
    pub dropped: u64,
}

/// What the thread of a source and its hub share.
#[derive(Default)]
pub(crate) struct Shared {
    inner: Mutex<Inner>,
    stop: AtomicBool,
}

#[derive(Default)]
pub(crate) struct Inner {
    pub queue: Queue,
    pub counts: Counts,
}

impl Shared {
    /// A thread that panicked leaves a queue that is still a queue.
    pub fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Presence {
    Unknown,
    Found,
    Lost,
}

/// The thread's end.
pub(crate) struct Outbox {
    shared: Arc<Shared>,
    presence: Presence,
    state: State,
}

impl Outbox {
    pub const fn new(shared: Arc<Shared>) -> Self {
        Self { shared, presence: Presence::Unknown, state: State::new() }
    }

    /// Whether the hub is gone.
    pub fn is_stopped(&self) -> bool {
        self.shared.stop.load(Ordering::Relaxed)
    }

    /// Whether the source is there, as far as anybody was told.
    pub fn is_found(&self) -> bool {
        self.presence == Presence::Found
    }

    /// The source is there; in a sentence, which is made only if that is new.
    pub fn found(&mut self, sentence: impl FnOnce() -> String) {
        if self.presence != Presence::Found {
            self.presence = Presence::Found;
            self.put([What::Found(sentence())]);
        }
    }

    /// The source is not there; in a sentence, which is made only if that is new.
    pub fn lost(&mut self, sentence: impl FnOnce() -> String) {
        if self.presence != Presence::Lost {
            self.presence = Presence::Lost;
            let released = self.state.release();
            self.put(released.into_iter().chain([What::Lost(sentence())]));
        }
    }

    fn put(&self, whats: impl IntoIterator<Item = What>) {
        let at = Instant::now();
        let mut inner = self.shared.lock();
        whats.into_iter().for_each(|what| inner.queue.push(Waiting { at, measured: None, what }));
    }

    /// What a message says that has just arrived.
    pub fn take(&mut self, message: Result<Parts, Refusal>) {
        let (at, since_epoch_s) = (Instant::now(), since_epoch_s());
        let mut inner = self.shared.lock();
        let inner = &mut *inner;
        inner.counts.messages += 1;
        for part in message.unwrap_or_else(|refusal| vec![Err(refusal)]) {
            match part {
                Err(refusal) => *inner.counts.refused.entry(refusal).or_default() += 1,
                Ok(Reading { stamp, said }) => {
                    if let Some(what) = self.state.change(said) {
                        let measured = stamp.map(|stamp| measured(stamp, since_epoch_s));
                        inner.queue.push(Waiting { at, measured, what });
                    }
                }
            }
        }
    }
}

/// This host's time of day.
fn since_epoch_s() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |time| time.as_secs_f64())
}

fn measured(stamp: Stamp, now_s: f64) -> Measured {
    match stamp {
        Stamp::Own(time) => Measured::Own(time),
        Stamp::Epoch(time) => {
            let ago_s = now_s - time.as_secs_f64();
            if ago_s.abs() <= IN_STEP_S { Measured::Ago(ago_s) } else { Measured::Own(time) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reading::Said;
    use std::time::Duration;

    #[test]
    fn times_of_day_are_compared_where_clocks_are_in_step() {
        let epoch = |seconds| measured(Stamp::Epoch(Duration::from_secs(seconds)), 1000.0);
        assert_eq!([epoch(1000), epoch(998), epoch(1003)], [0.0, 2.0, -3.0].map(Measured::Ago));
        assert_eq!(epoch(1037), Measured::Own(Duration::from_secs(1037)));
        assert_eq!(measured(Stamp::Own(Duration::ZERO), 1000.0), Measured::Own(Duration::ZERO));
    }

    #[test]
    fn a_source_that_goes_lets_its_buttons_go_first() {
        let shared = Arc::new(Shared::default());
        let mut outbox = Outbox::new(Arc::clone(&shared));
        let button = |is_down| Ok(vec![Ok(Said::Button(2, is_down).at(None)), Err(Refusal::Index)]);
        outbox.found(|| "it is there".into());
        outbox.take(button(true));
        outbox.take(button(true));
        outbox.take(Err(Refusal::Short));
        outbox.lost(|| "it is gone".into());
        outbox.lost(|| panic!("nothing new"));
        let mut inner = shared.lock();
        let whats: Vec<What> = inner.queue.take().into_iter().map(|event| event.what).collect();
        let button = |is_down| What::Button { index: 2, is_down };
        let expected =
            [What::Found("it is there".into()), button(true), button(false), What::Lost("it is gone".into())];
        assert_eq!(whats, expected);
        assert_eq!(inner.counts.messages, 3);
        assert_eq!(inner.counts.refused, [(Refusal::Index, 2), (Refusal::Short, 1)].into());
    }
}
