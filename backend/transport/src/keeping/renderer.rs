//! The child of a keeper: a process, and the messages to and from it.

use super::stream::{incoming, length_of};
use crossbeam_channel::{Receiver, RecvTimeoutError, TryRecvError};
use signal_hook::low_level::signal_name;
use std::io::{self, ErrorKind, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, ExitStatus};
use std::time::{Duration, Instant};

/// How long a message may wait for room in the stream, once it is full: only one that does not listen lets it be full.
const ROOM: Duration = Duration::from_millis(1);

/// More than a look takes. What is beyond it the keeper itself was held up, or stopped together with its child.
const LONGEST_LOOK: Duration = Duration::from_millis(20);

/// How long a killed process may take to be gone when nobody waits for it any more.
const LAST_LOOK: Duration = Duration::from_millis(300);

/// The keeper's handle on it. Dropped, it is killed.
pub struct Renderer {
    child: Child,
    stream: UnixStream,
    inbox: Receiver<Vec<u8>>,
    /// What there was no room for in the stream yet.
    outbox: Vec<u8>,
    /// For how long it has said nothing while somebody listened.
    silence: Duration,
    looked_at: Instant,
}

/// What comes from it.
pub enum Heard {
    /// A message.
    Message(Vec<u8>),
    /// Nothing.
    Nothing,
    /// Nothing, and nothing will: it has ended, or closed its stream.
    End,
}

impl Renderer {
    /// Starts it; its standard input is the stream.
    ///
    /// # Errors
    /// The system cannot start it.
    pub fn start(mut command: Command) -> io::Result<Self> {
        let (stream, theirs) = UnixStream::pair()?;
        stream.set_write_timeout(Some(ROOM))?;
        let inbox = incoming(stream.try_clone()?)?;
        let child = command.stdin(OwnedFd::from(theirs)).spawn()?;
        let (silence, looked_at) = (Duration::ZERO, Instant::now());
        Ok(Self { child, stream, inbox, outbox: Vec::new(), silence, looked_at })
    }

    /// Its process number.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Sends a message to it. It never waits for longer than a moment.
    pub fn send(&mut self, message: &[u8]) {
        self.outbox.extend(length_of(message));
        self.outbox.extend(message);
        self.push();
    }

    fn push(&mut self) {
        while !self.outbox.is_empty() {
            match self.stream.write(&self.outbox) {
                Ok(written) => drop(self.outbox.drain(..written)),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return,
                // It is gone, which is seen where its messages come from.
                Err(_) => self.outbox.clear(),
            }
        }
    }

    /// What comes from it within a time; zero is to let others run.
    pub fn receive(&mut self, timeout: Duration) -> Heard {
        self.push();
        let received = match timeout {
            Duration::ZERO => self.inbox.try_recv().map_err(|error| match error {
                TryRecvError::Empty => RecvTimeoutError::Timeout,
                TryRecvError::Disconnected => RecvTimeoutError::Disconnected,
            }),
            timeout => self.inbox.recv_timeout(timeout),
        };
        let looked = self.looked_at.elapsed().min(LONGEST_LOOK);
        self.looked_at = Instant::now();
        match received {
            Ok(message) => {
                self.silence = Duration::ZERO;
                Heard::Message(message)
            }
            Err(RecvTimeoutError::Timeout) => {
                self.silence += looked;
                if timeout.is_zero() {
                    std::thread::yield_now();
                }
                Heard::Nothing
            }
            Err(RecvTimeoutError::Disconnected) => Heard::End,
        }
    }

    /// For how long it has said nothing while somebody listened.
    pub fn silence(&self) -> Duration {
        self.silence
    }

    /// Ends it, whatever it does.
    pub fn kill(&mut self) {
        // Who is gone already need not be killed.
        let _ = self.child.kill();
    }

    /// How it ended, once it has.
    pub fn end(&mut self) -> Option<String> {
        match self.child.try_wait() {
            Ok(status) => status.map(how),
            Err(error) => Some(format!("has ended, and the system does not say how: {error}")),
        }
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        self.kill();
        let since = Instant::now();
        while self.end().is_none() && since.elapsed() < LAST_LOOK {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

/// How a process ended, after its name.
fn how(status: ExitStatus) -> String {
    match (status.signal(), status.code()) {
        (Some(signal), _) => {
            let name = signal_name(signal).map(|name| format!(" ({name})")).unwrap_or_default();
            format!("was ended by signal {signal}{name}")
        }
        (None, Some(code)) => format!("ended with exit code {code}"),
        (None, None) => "ended".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ended(script: &str) -> String {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        let mut renderer = Renderer::start(command).unwrap();
        let since = Instant::now();
        loop {
            assert!(since.elapsed() < Duration::from_secs(20), "it has not ended");
            if let (Heard::End, Some(how)) = (renderer.receive(Duration::from_millis(1)), renderer.end()) {
                return how;
            }
        }
    }

    #[test]
    fn it_is_known_how_a_process_ended() {
        assert_eq!(ended("exit 3"), "ended with exit code 3");
        assert_eq!(ended("kill -KILL $$"), "was ended by signal 9 (SIGKILL)");
        assert_eq!(ended("kill -SEGV $$"), "was ended by signal 11 (SIGSEGV)");
    }

    #[test]
    fn one_that_does_not_listen_holds_nobody_up_and_ends_with_its_handle() {
        let mut command = Command::new("sleep");
        command.arg("100");
        let mut renderer = Renderer::start(command).unwrap();
        let since = Instant::now();
        for _ in 0..20 {
            renderer.send(&[1; 100_000]);
        }
        assert!(since.elapsed() < Duration::from_secs(5));
        assert!(!renderer.outbox.is_empty(), "the stream has room for all of it");
        while renderer.silence() < Duration::from_millis(100) {
            assert!(matches!(renderer.receive(Duration::from_millis(5)), Heard::Nothing));
        }
        let process = renderer.process();
        drop(renderer);
        assert_ne!(crate::process::is_running(process), Some(true));
    }
}
