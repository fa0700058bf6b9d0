//! Back-ends as threads of this process.

use super::link::{Link, LinkError, WITHOUT_END, WorkerLink};
use super::opened::Opened;
use super::render_loop::panic_sentence;
use super::restarts::Restarts;
use super::worker::serve;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded, never, unbounded};
use protocol::{FromBackend, FromFrontend, Held, Setup};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// How many messages a back-end may be ahead of the front-end before it waits. Few, because each may be a picture.
const AHEAD_PER_BACKEND: usize = 4;

/// How long threads may take to quit; they only drop their renderer.
const PARTING: Duration = Duration::from_secs(10);

enum Parcel {
    Message(FromBackend),
    Ended(String),
}

/// The front-end's end of back-ends that are threads.
pub struct ThreadLink {
    outboxes: Vec<Sender<FromFrontend>>,
    inbox: Receiver<(usize, Parcel)>,
    threads: Vec<JoinHandle<()>>,
    restarts: Vec<Restarts>,
    /// What each showed last.
    held: Vec<Option<Box<Held>>>,
    /// Starts a back-end, with a link of its own.
    start: Box<dyn Fn(ThreadWorkerLink) -> std::io::Result<JoinHandle<()>> + Send>,
    /// Where what they say goes.
    outbox: Option<Sender<(usize, Parcel)>>,
}

struct ThreadWorkerLink {
    backend: usize,
    inbox: Receiver<FromFrontend>,
    outbox: Sender<(usize, Parcel)>,
    /// Those before it ended soon after their start, so it waits before it begins.
    wait: Duration,
    /// What came while it waited.
    came: Option<FromFrontend>,
}

/// Starts `count` back-ends; each opens its renderer with `make`. When the link is dropped they end by themselves.
pub fn spawn<M>(count: usize, make: M) -> Result<ThreadLink, LinkError>
where
    M: Fn(Setup) -> Result<Opened, String> + Send + Sync + 'static,
{
    let make = Arc::new(make);
    let start = move |link: ThreadWorkerLink| {
        let make = Arc::clone(&make);
        Builder::new().name(format!("back-end {}", link.backend)).spawn(move || run(link, make))
    };
    let (outbox, inbox) = bounded(AHEAD_PER_BACKEND * count);
    let mut link = ThreadLink {
        outboxes: Vec::new(),
        inbox,
        threads: Vec::new(),
        restarts: Vec::new(),
        held: vec![None; count],
        start: Box::new(start),
        outbox: Some(outbox),
    };
    for backend in 0..count {
        let (to_worker, thread) = link.start(backend, Duration::ZERO)?;
        link.restarts.push(Restarts::default());
        link.outboxes.push(to_worker);
        link.threads.push(thread);
    }
    Ok(link)
}

impl ThreadLink {
    fn start(
        &self,
        backend: usize,
        wait: Duration,
    ) -> Result<(Sender<FromFrontend>, JoinHandle<()>), LinkError> {
        let failed = |how: String| LinkError::Ended { backend, how };
        let outbox = self.outbox.clone().ok_or_else(|| failed("the run is over".to_owned()))?;
        let (to_worker, inbox) = unbounded();
        let thread = (self.start)(ThreadWorkerLink { backend, inbox, outbox, wait, came: None });
        let thread = thread.map_err(|error| failed(format!("no thread could be started: {error}")))?;
        Ok((to_worker, thread))
    }
}

fn run<M>(mut link: ThreadWorkerLink, make: Arc<M>)
where
    M: Fn(Setup) -> Result<Opened, String> + Send + Sync + 'static,
{
    link.hold_off();
    let how = match catch_unwind(AssertUnwindSafe(|| serve(&mut link, move |setup| make(setup)))) {
        Ok(Ok(())) => "its thread ended".to_owned(),
        Ok(Err(error)) => error.to_string(),
        Err(panic) => panic_sentence(panic.as_ref()),
    };
    // Fails only when the front-end has dropped its end, and then it does not matter.
    let _ = link.outbox.send((link.backend, Parcel::Ended(how)));
}

impl Link for ThreadLink {
    fn backends(&self) -> usize {
        self.outboxes.len()
    }

    fn name(&self, backend: usize) -> String {
        format!("back-end {backend} (a thread of this process)")
    }

    /// A thread that is gone has sent, or will send, a parcel that says so: that is reported, not this.
    fn send(&mut self, backend: usize, message: &FromFrontend) -> Result<(), LinkError> {
        let mut message = message.clone();
        if let FromFrontend::Setup(setup) = &mut message {
            setup.held = self.held[backend].clone();
        }
        let _ = self.outboxes[backend].send(message);
        Ok(())
    }

    fn broadcast(&mut self, message: &FromFrontend) -> Result<(), LinkError> {
        (0..self.backends()).try_for_each(|backend| self.send(backend, message))
    }

    fn receive(&mut self, timeout: Duration) -> Result<(usize, FromBackend), LinkError> {
        match self.inbox.recv_timeout(timeout) {
            Ok((backend, Parcel::Message(FromBackend::Held(held)))) => {
                self.held[backend] = Some(held);
                self.receive(timeout)
            }
            Ok((backend, Parcel::Message(message))) => {
                if let FromBackend::Ready(_) = message {
                    self.restarts[backend].ready(Instant::now());
                }
                Ok((backend, message))
            }
            Ok((backend, Parcel::Ended(how))) => Err(LinkError::Ended { backend, how }),
            Err(RecvTimeoutError::Timeout) => Err(LinkError::Silent),
            Err(RecvTimeoutError::Disconnected) => {
                Err(LinkError::Ended { backend: 0, how: "no back-end is left".to_owned() })
            }
        }
    }

    fn set_activity(&mut self, _: &str) {}

    fn revive(&mut self, backend: usize) -> Result<bool, LinkError> {
        let wait = self.restarts[backend].ended(Instant::now());
        let (outbox, thread) = self.start(backend, wait)?;
        (self.outboxes[backend], self.threads[backend]) = (outbox, thread);
        Ok(true)
    }

    fn finish(&mut self) -> Result<(), LinkError> {
        self.outboxes.clear();
        self.outbox = None;
        // Who waits for room in the inbox goes on.
        self.inbox = never();
        let threads = std::mem::take(&mut self.threads);
        let since = Instant::now();
        for (backend, thread) in threads.into_iter().enumerate() {
            while !thread.is_finished() {
                if since.elapsed() > PARTING {
                    let how =
                        format!("its thread still runs {} s after it was asked to end", PARTING.as_secs());
                    return Err(LinkError::Ended { backend, how });
                }
                std::thread::sleep(Duration::from_millis(1));
            }
        }
        Ok(())
    }
}

impl ThreadWorkerLink {
    /// Waits as it was told to; the end of the run cuts it short.
    fn hold_off(&mut self) {
        if !self.wait.is_zero() {
            self.came = self.inbox.recv_timeout(self.wait).ok();
        }
    }
}

impl WorkerLink for ThreadWorkerLink {
    fn send(&mut self, message: FromBackend) -> Result<(), LinkError> {
        self.outbox.send((self.backend, Parcel::Message(message))).map_err(|_| frontend_dropped())
    }

    fn receive(&mut self, timeout: Duration) -> Result<FromFrontend, LinkError> {
        if let Some(message) = self.came.take() {
            return Ok(message);
        }
        self.inbox.recv_timeout(timeout).map_err(|error| match error {
            RecvTimeoutError::Timeout => LinkError::Silent,
            RecvTimeoutError::Disconnected => frontend_dropped(),
        })
    }

    /// Without end: in one process the channel shows at once when the front-end is gone, and a program may well
    /// leave its display idle for a day.
    fn frontend_silence(&self) -> Duration {
        WITHOUT_END
    }
}

fn frontend_dropped() -> LinkError {
    LinkError::FrontendEnded("it has dropped its end of the channel".to_owned())
}
