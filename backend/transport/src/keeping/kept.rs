//! A renderer in a process of its own, whose keeper is its parent: messages come and go over its standard input.

use super::stream::{incoming, length_of};
use crate::launch::say;
use crate::link::{LinkError, WITHOUT_END, WorkerLink};
use crate::opened::Opened;
use crate::watchdog;
use crate::worker::{WorkerError, serve};
use crossbeam_channel::{Receiver, RecvTimeoutError};
use protocol::wire::{decode, encode};
use protocol::{FromBackend, FromFrontend, Setup};
use std::io::{self, Write};
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::parent_id;
use std::process::ExitCode;
use std::time::Duration;

/// The argument that makes a back-end program a kept renderer; the process number of its keeper follows.
pub(super) const KEPT_BY: &str = "--kept-by";

/// The keeper of this process, where its arguments name one.
pub fn keeper() -> Option<u32> {
    let mut arguments = std::env::args().skip(1);
    arguments.next().filter(|argument| argument == KEPT_BY)?;
    arguments.next()?.parse().ok()
}

/// The whole life of a kept renderer: serves the front-end beyond its keeper. The front-end shows the renderer's errors;
/// this prints only what nobody else can know.
pub fn work<M>(make: M, keeper: u32) -> ExitCode
where
    M: FnOnce(Setup) -> Result<Opened, String> + Send + 'static,
{
    let served = end_with(keeper).and_then(|()| KeptLink::connect()).map_err(WorkerError::from);
    match served.and_then(|mut link| serve(&mut link, make)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(WorkerError::Failed(_) | WorkerError::Link(LinkError::FrontendEnded(_))) => ExitCode::FAILURE,
        Err(error) => {
            say("lightloom-backend", &error.to_string());
            ExitCode::FAILURE
        }
    }
}

/// Has this process end when its keeper does, also while it is stopped or its threads are stuck.
fn end_with(keeper: u32) -> Result<(), LinkError> {
    watchdog::guard_kept().map_err(LinkError::Launch)?;
    // Elsewhere the end of the stream has to do.
    #[cfg(target_os = "linux")]
    rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL))
        .map_err(|error| LinkError::Launch(format!("it cannot be bound to its keeper: {error}")))?;
    // The keeper may have ended before that.
    match parent_id() == keeper {
        true => Ok(()),
        false => Err(frontend_ended()),
    }
}

/// The renderer's end of the stream.
struct KeptLink {
    stream: UnixStream,
    inbox: Receiver<Vec<u8>>,
}

impl KeptLink {
    fn connect() -> Result<Self, LinkError> {
        let connect = || -> io::Result<Self> {
            let stream = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
            Ok(Self { inbox: incoming(stream.try_clone()?)?, stream })
        };
        connect().map_err(|error| LinkError::Launch(format!("it cannot hear its keeper: {error}")))
    }
}

impl WorkerLink for KeptLink {
    fn send(&mut self, message: FromBackend) -> Result<(), LinkError> {
        let bytes = encode(&message)?;
        let sent = self.stream.write_all(&length_of(&bytes)).and_then(|()| self.stream.write_all(&bytes));
        sent.map_err(|_| frontend_ended())
    }

    fn receive(&mut self, timeout: Duration) -> Result<FromFrontend, LinkError> {
        match self.inbox.recv_timeout(timeout) {
            Ok(bytes) => Ok(decode(&bytes)?),
            Err(RecvTimeoutError::Timeout) => Err(LinkError::Silent),
            Err(RecvTimeoutError::Disconnected) => Err(frontend_ended()),
        }
    }

    /// Without end: the keeper listens to the front-end, and its own end is seen at once.
    fn frontend_silence(&self) -> Duration {
        WITHOUT_END
    }

    /// The keeper ends it, whatever its threads do, and starts another.
    fn can_be_replaced(&self) -> bool {
        true
    }
}

fn frontend_ended() -> LinkError {
    LinkError::FrontendEnded("the keeper of this process is gone".to_owned())
}
