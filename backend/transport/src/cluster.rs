//! The front-end's end of back-ends that are ranks of an MPI job: rank 0 is the front-end, rank i + 1 is back-end i.

use super::introduction::{FRONTEND_RANK, IS_BACKEND, IS_FRONTEND, await_introduction, introduction};
use super::launch::HOW_TO_LAUNCH;
use super::link::{Link, LinkError};
use super::mpi::Messenger;
use super::pause::Pause;
use super::rest::{DOZE, Rest};
use super::roster::{Roster, WHAT_TO_DO};
use super::watchdog;
use protocol::wire::{decode, encode};
use protocol::{FromBackend, FromFrontend};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How often to check that back-ends' processes run.
const LOOK_INTERVAL: Duration = Duration::from_millis(200);

/// How long messages of a dead back-end may still arrive before it counts as lost.
const LAST_MESSAGES: Duration = Duration::from_millis(300);

/// The front-end's end of back-ends that are ranks.
pub struct ClusterLink {
    messenger: Messenger,
    roster: Arc<Mutex<Roster>>,
    gone_since: Vec<Option<Instant>>,
    last_look: Instant,
    first_to_poll: usize,
    rest: Rest,
}

/// Joins the job as its front-end. An error is a sentence to end with, by [`crate::fail`]. From here on, the launcher's signal to
/// end prints which back-end was lost and ends this process.
pub fn connect() -> Result<ClusterLink, LinkError> {
    let mut messenger = Messenger::start().map_err(LinkError::Launch)?;
    let (rank, ranks) = (messenger.rank(), messenger.size());
    if rank != FRONTEND_RANK {
        return Err(second_frontend(&mut messenger, rank));
    }
    let roster = Arc::new(Mutex::new(Roster { activity: "connecting".to_owned(), ..Roster::default() }));
    watchdog::guard_frontend(Arc::clone(&roster)).map_err(LinkError::Launch)?;
    let mut peers = Vec::new();
    for rank in 1..ranks {
        match await_introduction(&mut messenger, rank)? {
            (IS_BACKEND, peer) => peers.push(peer),
            _ => return Err(LinkError::Launch(two_frontends(rank))),
        }
    }
    if peers.is_empty() {
        return Err(LinkError::Launch(format!("no back-end was started; start them with `{HOW_TO_LAUNCH}`")));
    }
    let greeting = introduction(IS_FRONTEND);
    for rank in 1..ranks {
        messenger.post(rank, Arc::clone(&greeting)).map_err(LinkError::Launch)?;
    }
    let gone_since = vec![None; peers.len()];
    roster.lock().unwrap_or_else(PoisonError::into_inner).backends = peers;
    Ok(ClusterLink {
        messenger,
        roster,
        gone_since,
        last_look: Instant::now(),
        first_to_poll: 0,
        rest: Rest::new(Instant::now()),
    })
}

fn two_frontends(rank: usize) -> String {
    format!("ranks 0 and {rank} are both a front-end; one is enough: `{HOW_TO_LAUNCH}`")
}

/// Sends the sentence to rank 0, which prints it and ends the job; prints it itself if that does not happen.
fn second_frontend(messenger: &mut Messenger, rank: usize) -> LinkError {
    let told = messenger.post(FRONTEND_RANK, introduction(IS_FRONTEND));
    let since = Instant::now();
    while told.is_ok() && since.elapsed() < Duration::from_secs(10) && messenger.is_sending().is_ok() {
        std::thread::sleep(Duration::from_millis(10));
    }
    LinkError::Launch(two_frontends(rank))
}

impl ClusterLink {
    fn roster(&self) -> MutexGuard<'_, Roster> {
        self.roster.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The bytes of one message that has arrived, from any back-end; the search starts after the last one served.
    fn poll(&mut self) -> Result<Option<(usize, Vec<u8>)>, LinkError> {
        let backends = self.backends();
        for turn in 0..backends {
            let backend = (self.first_to_poll + turn) % backends;
            let polled = self.messenger.poll(backend + 1);
            if let Some(bytes) = polled.map_err(|how| LinkError::Ended { backend, how })? {
                self.first_to_poll = (backend + 1) % backends;
                self.gone_since[backend] = self.gone_since[backend].map(|_| Instant::now());
                return Ok(Some((backend, bytes)));
            }
        }
        Ok(None)
    }

    /// Names a back-end that is gone and whose last messages have arrived.
    fn look_for_gone(&mut self) -> Result<(), LinkError> {
        if self.last_look.elapsed() < LOOK_INTERVAL {
            return Ok(());
        }
        self.last_look = Instant::now();
        let gone = self.roster().gone();
        for backend in gone {
            if self.gone_since[backend].get_or_insert_with(Instant::now).elapsed() > LAST_MESSAGES {
                return Err(LinkError::Ended { backend, how: WHAT_TO_DO.to_owned() });
            }
        }
        Ok(())
    }

    fn post(&mut self, backend: usize, bytes: Arc<[u8]>) -> Result<(), LinkError> {
        self.messenger.post(backend + 1, bytes).map_err(|how| LinkError::Ended { backend, how })
    }
}

impl Link for ClusterLink {
    fn backends(&self) -> usize {
        self.gone_since.len()
    }

    fn name(&self, backend: usize) -> String {
        self.roster().name(backend)
    }

    fn send(&mut self, backend: usize, message: &FromFrontend) -> Result<(), LinkError> {
        self.rest.note(message, Instant::now());
        self.post(backend, encode(message)?.into())
    }

    fn broadcast(&mut self, message: &FromFrontend) -> Result<(), LinkError> {
        self.rest.note(message, Instant::now());
        let bytes: Arc<[u8]> = encode(message)?.into();
        (0..self.backends()).try_for_each(|backend| self.post(backend, Arc::clone(&bytes)))
    }

    fn receive(&mut self, timeout: Duration) -> Result<(usize, FromBackend), LinkError> {
        let since = Instant::now();
        let mut pause = Pause::default();
        loop {
            // An error in sending belongs to a back-end that is lost, and is noticed as such by its process or silence.
            let is_moving = self.messenger.is_sending().unwrap_or(false) || self.messenger.is_moving();
            if let Some((backend, bytes)) = self.poll()? {
                let decoded = decode(&bytes).map_err(|error| LinkError::Garbled { backend, error })?;
                self.rest.note(&decoded, Instant::now());
                return Ok((backend, decoded));
            }
            self.look_for_gone()?;
            if since.elapsed() >= timeout {
                return Err(LinkError::Silent);
            }
            match self.rest.is_dozing(Instant::now()) && !is_moving {
                true => std::thread::sleep(DOZE.min(timeout.saturating_sub(since.elapsed()))),
                false => pause.wait(is_moving),
            }
        }
    }

    fn is_at_rest(&self) -> bool {
        self.rest.is_at_rest(Instant::now())
    }

    fn set_activity(&mut self, activity: &str) {
        self.roster().activity = activity.to_owned();
    }

    /// A launcher ends the job when a rank ends; the renderers of a show are not ranks.
    fn revive(&mut self, _: usize) -> Result<bool, LinkError> {
        Ok(false)
    }

    fn finish(&mut self) -> Result<(), LinkError> {
        let has_parted = watchdog::guard_parting("lightloom").map_err(LinkError::Launch)?;
        while self.messenger.is_sending().map_err(LinkError::Launch)? {
            std::thread::sleep(Duration::from_micros(100));
        }
        self.messenger.end();
        has_parted.store(true, Ordering::SeqCst);
        // Losing a back-end no longer matters from here on.
        *self.roster() = Roster { activity: "working on what was drawn".to_owned(), ..Roster::default() };
        Ok(())
    }
}
