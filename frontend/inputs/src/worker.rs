//! The thread of a source: it looks for the source, listens to it, and looks for it again.

use crate::datagrams::Datagrams;
use crate::outbox::{Outbox, Shared};
use crate::pause::Pause;
use crate::records::Records;
use crate::vrpn::Client;
use std::io::Result;
use std::sync::Arc;
use std::thread::{Builder, Thread, park_timeout};
use std::time::Instant;

/// A source that has a thread.
pub(crate) enum Source {
    Vrpn(Client),
    Datagrams(Datagrams),
    Records(Records),
}

impl Source {
    /// Listens until the source is gone. Why it ended, or anything if nobody wants it any more.
    fn attend(&mut self, outbox: &mut Outbox) -> String {
        match self {
            Self::Vrpn(client) => client.attend(outbox),
            Self::Datagrams(datagrams) => datagrams.attend(outbox),
            Self::Records(records) => records.attend(outbox),
        }
    }

    fn work(&mut self, outbox: &mut Outbox) {
        let mut pause = Pause::new();
        while !outbox.is_stopped() {
            let why = self.attend(outbox);
            if outbox.is_stopped() {
                return;
            }
            if outbox.is_found() {
                pause = Pause::new();
            }
            outbox.lost(|| why);
            let until = Instant::now() + pause.next();
            while let Some(left) = until.checked_duration_since(Instant::now())
                && !outbox.is_stopped()
            {
                park_timeout(left);
            }
        }
    }
}

/// Starts a source's thread, which ends by itself soon after it is asked to.
pub(crate) fn start(name: &str, mut source: Source, shared: Arc<Shared>) -> Result<Thread> {
    let mut outbox = Outbox::new(shared);
    // The system cuts long names of threads; a zero byte in one would be an error.
    let thread = Builder::new().name(format!("input {}", name.replace('\0', " ")));
    Ok(thread.spawn(move || source.work(&mut outbox))?.thread().clone())
}
