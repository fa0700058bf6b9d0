//! The thread of a back-end that shows frames when they are due.

use super::stage::Stage;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, unbounded};
use std::sync::LazyLock;
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// The clock of this process.
static START: LazyLock<Instant> = LazyLock::new(Instant::now);

/// What the clock of this process says, microseconds.
pub fn now_us() -> u64 {
    START.elapsed().as_micros() as u64
}

/// What the messages' thread tells it.
enum Cue {
    Drawn(u32),
    Show { frame: u32, at_us: u64 },
}

/// A frame, and since when it is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Its number.
    pub frame: u32,
    /// On this process's clock, microseconds.
    pub at_us: u64,
}

/// The messages' thread's handle on it.
pub struct ShowThread {
    cues: Option<Sender<Cue>>,
    told: Receiver<Shown>,
    thread: Option<JoinHandle<()>>,
}

impl ShowThread {
    /// Starts it.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn start() -> std::io::Result<Self> {
        let (cues, inbox) = unbounded();
        let (outbox, told) = unbounded();
        let thread = Builder::new().name("showing".to_owned()).spawn(move || run(&inbox, &outbox))?;
        Ok(Self { cues: Some(cues), told, thread: Some(thread) })
    }

    /// A frame is drawn.
    pub fn drawn(&self, frame: u32) {
        self.cue(Cue::Drawn(frame));
    }

    /// A frame is to be shown, at a time on this process's clock or as soon as it can be.
    pub fn show(&self, frame: u32, at_us: Option<u64>) {
        self.cue(Cue::Show { frame, at_us: at_us.unwrap_or(0) });
    }

    /// The frames that were shown, one after another.
    pub fn told(&self) -> &Receiver<Shown> {
        &self.told
    }

    fn cue(&self, cue: Cue) {
        // The thread ends when this handle is dropped, and not before.
        let _ = self.cues.as_ref().map(|cues| cues.send(cue));
    }
}

impl Drop for ShowThread {
    fn drop(&mut self) {
        self.cues = None;
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

fn run(inbox: &Receiver<Cue>, outbox: &Sender<Shown>) {
    let mut stage = Stage::default();
    loop {
        let cue = match stage.due(now_us()) {
            None => inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
            Some((frame, when)) => match when.checked_sub(now_us()) {
                None | Some(0) => {
                    stage.shown(frame);
                    // Nobody may want to know any more.
                    let _ = outbox.send(Shown { frame, at_us: now_us() });
                    continue;
                }
                Some(left_us) => inbox.recv_timeout(Duration::from_micros(left_us)),
            },
        };
        match cue {
            Ok(Cue::Drawn(frame)) => stage.drawn(frame),
            Ok(Cue::Show { frame, at_us }) => stage.order(frame, at_us),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_never_shown_before_its_time() {
        let thread = ShowThread::start().unwrap();
        let at_us = now_us() + 20_000;
        thread.drawn(7);
        thread.show(7, Some(at_us));
        let shown = thread.told().recv_timeout(Duration::from_secs(10)).unwrap();
        assert_eq!(shown.frame, 7);
        assert!(shown.at_us >= at_us, "{shown:?}, due at {at_us}");
    }
}
