//! Loader threads: they fetch and unpack bricks while others wait or work.

mod load;
#[cfg(test)]
mod loader_tests;
#[cfg(test)]
mod model_tests;
mod pantry;
mod queue;
#[cfg(test)]
mod test_source;

pub use load::{Fetched, LoadedBrick, SAMPLE_BYTES};
pub use queue::LoaderCounts;
pub(super) use queue::Queue;

use bricks::{BrickError, BrickSource, NodeKey};
use crossbeam_channel::unbounded;
use load::load;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Bytes of bricks in memory that were read before they were asked for: a second or so of a fast disk.
pub const PANTRY_BYTES: u64 = 256 << 20;

/// How long a loader's end waits for reads that have begun. Most take a few milliseconds; a disk that does not answer
/// must not hold up the end of the program.
const PATIENCE: Duration = Duration::from_millis(200);

/// A few threads that read bricks: for complete frames, which wait for them ([`Loader::fetch`]), and for live ones,
/// which never do ([`Loader::want`], [`Loader::arrived`]). No call but `fetch` and `wait` waits for a read.
///
/// When it is dropped, threads that wait for work end at once. Those inside a read have 200 ms; after that they
/// are left to themselves: each ends when its read does, holds the source until then, and its brick is lost.
#[derive(Debug)]
pub struct Loader {
    desk: Arc<Desk>,
}

/// What the threads and the loader's owner share.
#[derive(Debug)]
struct Desk {
    state: Mutex<State>,
    /// There may be something to read.
    work: Condvar,
    /// Something came, or a thread ended.
    news: Condvar,
}

#[derive(Debug)]
struct State {
    queue: Queue,
    /// Threads that have not ended.
    alive: usize,
    is_closed: bool,
}

impl Loader {
    /// Starts `threads` threads that read from `source`. What they read stays in memory until it is taken, up to
    /// `pantry_bytes` of samples, and at least one brick per thread.
    pub fn new(source: Arc<dyn BrickSource>, threads: usize, pantry_bytes: u64) -> Self {
        let threads = threads.max(1);
        let state = State { queue: Queue::new(threads, pantry_bytes), alive: threads, is_closed: false };
        let desk = Arc::new(Desk { state: Mutex::new(state), work: Condvar::new(), news: Condvar::new() });
        for _ in 0..threads {
            let (source, seat) = (Arc::clone(&source), Seat(Arc::clone(&desk)));
            std::thread::spawn(move || {
                seat.0.serve(&*source);
                // Before the seat, so that the source is free for whatever waits for the thread's end.
                drop(source);
                drop(seat);
            });
        }
        Self { desk }
    }

    /// Fetches bricks, in any order of arrival, and hands each, or why it cannot be read, to `arrived`. They go before
    /// what is wanted. A brick that is there already, or being read, is not read again.
    ///
    /// # Errors
    /// The threads ended before their time.
    pub fn fetch(&self, keys: &[NodeKey], mut arrived: impl FnMut(Fetched)) -> Result<(), BrickError> {
        let (caller, results) = unbounded();
        let mut state = self.desk.lock();
        if state.alive == 0 {
            return Err(lost());
        }
        keys.iter().for_each(|&key| state.queue.fetch(key, &caller));
        drop((state, caller));
        self.desk.work.notify_all();
        for _ in keys {
            arrived(results.recv().map_err(|_| lost())?);
        }
        Ok(())
    }

    /// Replaces the list: threads read `ordered` from its first on, and `prefetch`, from its first
    /// on, when nothing of `ordered` is left to begin; one thread, if there are two, stays free of `prefetch`. What is
    /// being read is finished and kept for a while, wanted or not. Returns how many queued bricks were dropped.
    ///
    /// `ordered` names what the caller lacks: a brick that was handed over before and is named again is read again.
    pub fn want(&self, ordered: &[NodeKey], prefetch: &[NodeKey]) -> usize {
        let cancelled = self.desk.lock().queue.want(ordered, prefetch);
        self.desk.work.notify_all();
        // There may be news for waiting callers: bricks that were there already.
        self.desk.news.notify_all();
        cancelled
    }

    /// What has come of the list so far, first things first: every failed read, once, and bricks of at most so many
    /// bytes of samples ([`SAMPLE_BYTES`] each), but one in any case. The rest stays for later calls.
    ///
    /// What is handed over is no longer wanted. Failures come of every read but those of `fetch` alone: also of what
    /// was prefetched or is no longer wanted, so that the caller knows better than to name it again at once. See
    /// [`super::Retry`].
    pub fn arrived(&self, most_bytes: u64) -> Vec<Fetched> {
        let arrived = self.desk.lock().queue.arrived(most_bytes);
        // There may be room for more now.
        self.desk.work.notify_all();
        arrived
    }

    /// Waits until `arrived` would return something, nothing is left to read, or the time is over; returns whether it
    /// would. For callers that have nothing else to do.
    pub fn wait(&self, most: Duration) -> bool {
        let waits = |state: &mut State| !state.queue.has_news() && !state.queue.is_idle() && state.alive > 0;
        let state = self.desk.news.wait_timeout_while(self.desk.lock(), most, waits);
        state.unwrap_or_else(PoisonError::into_inner).0.queue.has_news()
    }

    /// Bricks being read.
    pub fn in_flight(&self) -> usize {
        self.counts().in_flight
    }

    /// Whether nothing is being read, nor will be before the next call of another method.
    pub fn is_idle(&self) -> bool {
        self.desk.lock().queue.is_idle()
    }

    /// What it did so far, and does now.
    pub fn counts(&self) -> LoaderCounts {
        self.desk.lock().queue.counts()
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        let mut state = self.desk.lock();
        state.is_closed = true;
        state.queue.close();
        self.desk.work.notify_all();
        // Whether all have ended or not, there is nothing more to do.
        drop(self.desk.news.wait_timeout_while(state, PATIENCE, |state| state.alive > 0));
    }
}

impl Desk {
    /// A thread that panicked while it held the lock has said so itself, and no step of the queue is left half done.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A thread's work until the loader is dropped.
    fn serve(&self, source: &dyn BrickSource) {
        while let Some(key) = self.begin() {
            let result = load(source, key);
            self.lock().queue.finish(key, result);
            self.news.notify_all();
        }
    }

    /// Waits for something to read; None at the end.
    fn begin(&self) -> Option<NodeKey> {
        let mut state = self.lock();
        while !state.is_closed {
            if let Some(key) = state.queue.begin() {
                return Some(key);
            }
            state = self.work.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        None
    }
}

/// A thread's place at the desk: it reports the thread's end, however it comes.
struct Seat(Arc<Desk>);

impl Drop for Seat {
    fn drop(&mut self) {
        let mut state = self.0.lock();
        state.alive -= 1;
        if state.alive == 0 {
            state.queue.close();
        }
        self.0.news.notify_all();
    }
}

fn lost() -> BrickError {
    BrickError::unavailable("a loader thread ended early; start the program again")
}
