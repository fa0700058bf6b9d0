//! A back-end that is a rank of an MPI job.

use super::introduction::{FRONTEND_RANK, IS_BACKEND, await_introduction, introduction};
use super::keeping::{Keeper, Taken};
use super::launch::{HOW_TO_LAUNCH, fail};
use super::link::{LinkError, WorkerLink};
use super::mpi::Messenger;
use super::opened::Opened;
use super::pause::Pause;
use super::rest::DOZE;
use super::watchdog;
use super::worker::{WorkerError, attend, greet};
use protocol::wire::{decode, encode};
use protocol::{FromBackend, FromFrontend, Setup};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long a back-end goes on without hearing from the front-end. Two minutes, because a front-end may be busy with
/// pictures between two frames; in longer work it calls [`super::Session::keep_alive`]. A front-end that dies on the
/// same host is noticed in a second whatever this says.
pub const FRONTEND_SILENCE: Duration = Duration::from_secs(120);

/// A back-end's end, in its own rank.
struct RankLink {
    messenger: Messenger,
    silence: Duration,
    /// A message that was taken to see what it is, and is still to be received.
    held: Option<FromFrontend>,
    is_parting: Arc<AtomicBool>,
    /// True once the launcher ends the job.
    is_ended: Arc<AtomicBool>,
}

impl RankLink {
    /// Joins the job as a back-end.
    fn connect(silence: Duration, is_ended: Arc<AtomicBool>) -> Result<Self, LinkError> {
        let mut messenger = Messenger::start().map_err(LinkError::Launch)?;
        if messenger.rank() == FRONTEND_RANK {
            return Err(LinkError::Launch(format!(
                "rank 0 must be the front-end; start with `{HOW_TO_LAUNCH}`"
            )));
        }
        messenger.post(FRONTEND_RANK, introduction(IS_BACKEND)).map_err(LinkError::FrontendEnded)?;
        let (_, frontend) = await_introduction(&mut messenger, FRONTEND_RANK)?;
        let is_parting = Arc::new(AtomicBool::new(false));
        watchdog::guard_backend(frontend, Arc::clone(&is_parting), Arc::clone(&is_ended))
            .map_err(LinkError::Launch)?;
        Ok(Self { messenger, silence, held: None, is_parting, is_ended })
    }

    fn check_end(&self) -> Result<(), LinkError> {
        match self.is_ended.load(Ordering::SeqCst) {
            true => Err(LinkError::FrontendEnded("the launcher ended the run".to_owned())),
            false => Ok(()),
        }
    }

    fn finish(mut self) -> Result<(), LinkError> {
        self.is_parting.store(true, Ordering::SeqCst);
        let has_parted = watchdog::guard_parting("lightloom-backend").map_err(LinkError::Launch)?;
        self.messenger.end();
        has_parted.store(true, Ordering::SeqCst);
        Ok(())
    }
}

impl RankLink {
    /// Passes messages on between the front-end and a renderer in a process of its own, until the front-end says Quit.
    fn keep(&mut self, mut keeper: Keeper) -> Result<(), WorkerError> {
        let (mut pause, mut heard_at) = (Pause::default(), Instant::now());
        loop {
            self.check_end()?;
            if let Some(bytes) = self.messenger.poll(FRONTEND_RANK).map_err(LinkError::FrontendEnded)? {
                (pause, heard_at) = (Pause::default(), Instant::now());
                if keeper.take(&bytes).map_err(LinkError::from)? == Taken::Quit {
                    keeper.part();
                    return Ok(());
                }
            }
            if heard_at.elapsed() > self.silence {
                return Err(WorkerError::FrontendSilent(self.silence.as_secs()));
            }
            // One picture after another: a renderer that is ahead of the front-end waits.
            if self.messenger.is_sending().map_err(LinkError::FrontendEnded)? {
                pause.wait(true);
                continue;
            }
            let is_moving = self.messenger.is_moving();
            let wait = if keeper.is_dozing() && !is_moving { DOZE } else { pause.length(is_moving) };
            if let Some(bytes) = keeper.next(wait) {
                pause = Pause::default();
                self.messenger.post(FRONTEND_RANK, bytes.into()).map_err(LinkError::FrontendEnded)?;
            }
        }
    }
}

impl WorkerLink for RankLink {
    fn send(&mut self, message: FromBackend) -> Result<(), LinkError> {
        self.messenger.post(FRONTEND_RANK, encode(&message)?.into()).map_err(LinkError::FrontendEnded)?;
        let since = Instant::now();
        let mut pause = Pause::default();
        while self.messenger.is_sending().map_err(LinkError::FrontendEnded)? {
            self.check_end()?;
            if since.elapsed() > self.silence {
                return Err(LinkError::FrontendEnded("it takes no messages any more".to_owned()));
            }
            pause.wait(true);
        }
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<FromFrontend, LinkError> {
        if let Some(held) = self.held.take() {
            return Ok(held);
        }
        let since = Instant::now();
        let mut pause = Pause::default();
        loop {
            self.check_end()?;
            if let Some(bytes) = self.messenger.poll(FRONTEND_RANK).map_err(LinkError::FrontendEnded)? {
                return Ok(decode(&bytes)?);
            }
            if since.elapsed() >= timeout {
                return Err(LinkError::Silent);
            }
            pause.wait(self.messenger.is_moving());
        }
    }

    fn frontend_silence(&self) -> Duration {
        self.silence
    }
}

/// The whole life of a back-end's rank: joins the job, serves the front-end, leaves. In a show a process of its own draws,
/// which this one keeps. The front-end shows the renderer's errors; this prints only what the front-end cannot know.
pub fn work<M>(make: M, frontend_silence: Duration) -> ExitCode
where
    M: FnOnce(Setup) -> Result<Opened, String> + Send + 'static,
{
    let is_ended = Arc::new(AtomicBool::new(false));
    let link = RankLink::connect(frontend_silence, Arc::clone(&is_ended)).map_err(WorkerError::from);
    let ended = link.and_then(|mut link| {
        greet(&mut link)?;
        match link.receive(frontend_silence) {
            Ok(FromFrontend::Setup(setup)) if setup.is_kept => {
                link.keep(Keeper::new(setup).map_err(LinkError::from)?)?;
            }
            Err(LinkError::Silent) => return Err(WorkerError::FrontendSilent(frontend_silence.as_secs())),
            first => {
                link.held = Some(first?);
                attend(&mut link, make)?;
            }
        }
        Ok(link.finish()?)
    });
    if is_ended.load(Ordering::SeqCst) {
        // What the renderer writes is complete; the watchdog ends this process, as the launcher asked.
        std::thread::sleep(2 * watchdog::STAY);
    }
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(WorkerError::Failed(_)) => ExitCode::FAILURE,
        Err(error) => fail("lightloom-backend", &error.to_string()),
    }
}
