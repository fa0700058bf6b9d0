//! A thread that ends this process when the run is over, even if the main thread is too busy to notice.

use super::launch::{is_first_to_say, say};
use super::roster::{Peer, Roster};
use signal_hook::consts::SIGTERM;
use signal_hook::iterator::Signals;
use signal_hook::low_level::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, sleep};
use std::time::{Duration, Instant};

/// How often to check that the front-end's process runs.
const LOOK_INTERVAL: Duration = Duration::from_millis(250);

/// How long a back-end outlives the signal that ends the job. The launcher sends it to all ranks when one dies; one that
/// stays a little can then be distinguished from the one that died first.
pub const STAY: Duration = Duration::from_millis(700);

/// How long the front-end looks for a dead back-end after that signal. Short: the launcher sends the signal because it
/// saw the death, and may itself be about to go.
const LOOK_FOR_DEAD: Duration = Duration::from_millis(50);

/// How long a back-end waits for that signal once the front-end is gone: a front-end that ended the run has said why,
/// and one line is enough. Longer than [`STAY`].
const WAIT_FOR_LAUNCHER: Duration = Duration::from_secs(1);

/// How long finalising MPI may take: it waits for all ranks.
const PARTING: Duration = Duration::from_secs(10);

const TERMINATED: i32 = 128 + SIGTERM;

/// In the front-end: when the launcher ends the job, says which back-end ended it, and exits.
pub fn guard_frontend(roster: Arc<Mutex<Roster>>) -> Result<(), String> {
    on_termination(move || {
        let since = Instant::now();
        let sentence = loop {
            let roster = roster.lock().unwrap_or_else(PoisonError::into_inner);
            let gone = roster.gone();
            if !gone.is_empty() {
                break roster.obituary(&gone);
            }
            if since.elapsed() > LOOK_FOR_DEAD {
                let activity = &roster.activity;
                break format!(
                    "the launcher ended the run (SIGTERM) while {activity}: it was asked to, or a back-end on another \
                     host ended; see what the launcher and that host say"
                );
            }
            drop(roster);
            sleep(Duration::from_millis(20));
        };
        if is_first_to_say() {
            say("lightloom", &sentence);
            exit(1);
        }
        // The main thread is printing the sentence. It ends the process, or this thread does.
        sleep(STAY);
        exit(1);
    })
}

/// In a back-end: stays a moment when the launcher ends the job, which makes `is_ended` true, and ends when the front-end's
/// process is gone, also in the middle of a frame. `is_parting` cancels this.
pub fn guard_backend(
    frontend: Peer,
    is_parting: Arc<AtomicBool>,
    is_ended: Arc<AtomicBool>,
) -> Result<(), String> {
    on_termination(move || {
        is_ended.store(true, Ordering::SeqCst);
        sleep(STAY);
        exit(TERMINATED);
    })?;
    spawn(move || {
        while !is_parting.load(Ordering::SeqCst) {
            if frontend.is_gone() {
                sleep(WAIT_FOR_LAUNCHER);
                let Peer { process, host, .. } = &frontend;
                say(
                    "lightloom-backend",
                    &format!("the front-end (process {process} on host {host}) is gone"),
                );
                exit(1);
            }
            sleep(LOOK_INTERVAL);
        }
    })
}

/// In a kept renderer: stays a moment when the launcher ends the job, so that its keeper, which is told too, does not take
/// it for lost.
pub fn guard_kept() -> Result<(), String> {
    on_termination(|| {
        sleep(STAY);
        exit(TERMINATED);
    })
}

/// Ends the process when finalising MPI does not return, because a rank was lost on the way out. What it returns
/// cancels this.
pub fn guard_parting(program: &'static str) -> Result<Arc<AtomicBool>, String> {
    let has_parted = Arc::new(AtomicBool::new(false));
    let watched = Arc::clone(&has_parted);
    spawn(move || {
        sleep(PARTING);
        if !watched.load(Ordering::SeqCst) {
            let seconds = PARTING.as_secs();
            eprintln!(
                "{program}: all frames are done, but a rank has not left after {seconds} s; ending without it"
            );
            exit(1);
        }
    })?;
    Ok(has_parted)
}

fn on_termination(then: impl FnOnce() + Send + 'static) -> Result<(), String> {
    let mut signals = Signals::new([SIGTERM]).map_err(|error| format!("no signal handler: {error}"))?;
    spawn(move || {
        if signals.forever().next().is_some() {
            then();
        }
    })
}

fn spawn(work: impl FnOnce() + Send + 'static) -> Result<(), String> {
    let thread = Builder::new().name("watchdog".to_owned()).spawn(work);
    thread.map(drop).map_err(|error| format!("no thread for the watchdog: {error}"))
}
