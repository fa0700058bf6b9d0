//! What a rank does that keeps a renderer: it passes messages on, and sees to it that there is a renderer.
//!
//! It knows nothing of ranks: whoever has it takes messages of the front-end to [`Keeper::take`] and those of
//! [`Keeper::next`] to the front-end. Neither of them waits for a renderer that hangs.

use super::kept::KEPT_BY;
use super::renderer::{Heard, Renderer};
use crate::rest::{Matter, Rest};
use crate::restarts::Restarts;
use protocol::wire::{WireError, decode, encode, has_picture};
use protocol::{FromBackend, FromFrontend, Held, Setup};
use std::io;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// After so long without a word it is asked for one. While a show goes on it says something every fifth of a second.
const ASK_AFTER: Duration = Duration::from_millis(400);

/// After so long without a word it hangs. The thread that passes its messages on does nothing else, and answers within a
/// millisecond, or tens of them on a busy machine. Longer than this leaves no time to show again within two seconds.
const HANGS_AFTER: Duration = Duration::from_millis(1500);

/// The same before its first word: its program may come from a slow disk.
const STARTS_WITHIN: Duration = Duration::from_secs(20);

/// How long one that is asked to quit may take: it leaves off after the tile at hand.
const PARTING: Duration = Duration::from_secs(4);

/// The question that is the keeper's own: no clock says so much.
const OWN_QUESTION: FromFrontend = FromFrontend::Clock { asked_us: u64::MAX };

/// The program that runs, whatever has become of its file.
const IN_MEMORY: &str = "/proc/self/exe";

/// What a message of the front-end was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// Something for the renderer.
    PassedOn,
    /// The end.
    Quit,
}

/// What a keeper has.
enum State {
    /// A renderer.
    Running(Child),
    /// One that is ending; how, where that is known before it has.
    Ending(Renderer, Option<String>),
    /// None, until a time.
    Waiting(Instant),
    /// None any more: the first one could not begin.
    Over,
}

/// A renderer that runs.
struct Child {
    renderer: Renderer,
    has_greeted: bool,
    /// Whether it has its setup: what the front-end says before is meant for the one before it.
    is_set_up: bool,
    is_asked: bool,
}

/// The keeper.
pub struct Keeper {
    /// How a renderer is started.
    command: Box<dyn Fn() -> io::Result<Command>>,
    state: State,
    /// The setup for the first renderer, until that has greeted.
    setup: Option<Vec<u8>>,
    /// What a renderer showed last.
    held: Option<Box<Held>>,
    /// Whether any ever drew a frame: what ends the first one before is no accident, and would end all.
    has_drawn: bool,
    restarts: Restarts,
    rest: Rest,
}

/// This program, as a kept renderer: also where another has taken its place on the disk, which may speak another protocol.
fn this_program() -> io::Result<Command> {
    let path = std::env::current_exe()?;
    let is_there = path.exists() || !Path::new(IN_MEMORY).exists();
    let mut command = Command::new(if is_there { &path } else { Path::new(IN_MEMORY) });
    command.arg(KEPT_BY).arg(std::process::id().to_string());
    Ok(command)
}

impl Keeper {
    /// Keeps a renderer, which is this program, for a front-end that has said this setup.
    ///
    /// # Errors
    /// The setup does not become bytes.
    pub fn new(setup: Box<Setup>) -> Result<Self, WireError> {
        Self::with(Box::new(this_program), setup)
    }

    fn with(command: Box<dyn Fn() -> io::Result<Command>>, setup: Box<Setup>) -> Result<Self, WireError> {
        let setup = Some(encode(&FromFrontend::Setup(setup))?);
        let state = State::Waiting(Instant::now());
        Ok(Self {
            command,
            state,
            setup,
            held: None,
            has_drawn: false,
            restarts: Restarts::default(),
            rest: Rest::new(Instant::now()),
        })
    }

    /// Takes a message of the front-end.
    ///
    /// # Errors
    /// It is none.
    pub fn take(&mut self, bytes: &[u8]) -> Result<Taken, WireError> {
        let message = decode::<FromFrontend>(bytes)?;
        if message == FromFrontend::Quit {
            return Ok(Taken::Quit);
        }
        self.rest.note(&message, Instant::now());
        if let State::Running(child) = &mut self.state {
            match message {
                FromFrontend::Setup(setup) if child.has_greeted => {
                    child.is_set_up = true;
                    let setup = Setup { held: self.held.clone(), ..*setup };
                    child.renderer.send(&encode(&FromFrontend::Setup(Box::new(setup)))?);
                }
                _ if child.is_set_up => child.renderer.send(bytes),
                _ => {}
            }
        }
        Ok(Taken::PassedOn)
    }

    /// The next message for the front-end, if one comes within a time; zero is to let others run.
    pub fn next(&mut self, timeout: Duration) -> Option<Vec<u8>> {
        match &mut self.state {
            State::Running(child) => match child.renderer.receive(timeout) {
                Heard::Message(bytes) => self.heed(bytes),
                Heard::Nothing => {
                    self.look_for_hang();
                    None
                }
                Heard::End => {
                    self.end(None);
                    None
                }
            },
            State::Ending(renderer, why) => match renderer.end() {
                Some(how) => {
                    let sentence = name(renderer.process(), &why.take().unwrap_or(how));
                    self.lose(sentence)
                }
                None => rest(timeout),
            },
            State::Waiting(until) => match until.checked_duration_since(Instant::now()) {
                None | Some(Duration::ZERO) => self.start(),
                Some(left) => rest(timeout.min(left)),
            },
            State::Over => rest(timeout),
        }
    }

    /// Whether the front-end has had nothing to say for long: its messages may be looked for now and then only.
    pub fn is_dozing(&self) -> bool {
        self.rest.is_dozing(Instant::now())
    }

    /// What comes from the renderer: bytes for the front-end, unless it is for the keeper.
    fn heed(&mut self, bytes: Vec<u8>) -> Option<Vec<u8>> {
        let State::Running(child) = &mut self.state else { return None };
        child.is_asked = false;
        if has_picture(&bytes) {
            self.rest.note(Matter::Work, Instant::now());
            return Some(bytes);
        }
        let decoded = decode::<FromBackend>(&bytes);
        // What cannot be understood ends the renderer, and that is work.
        let matter = decoded.as_ref().map_or(Matter::Work, Matter::from);
        if matter == Matter::Work {
            self.rest.note(matter, Instant::now());
        }
        match decoded {
            Err(error) => self.end(Some(format!("cannot be understood: {error}"))),
            Ok(FromBackend::Clock { asked_us: u64::MAX, .. }) => {}
            Ok(FromBackend::Held(held)) => self.held = Some(held),
            Ok(FromBackend::Hello(_)) => {
                child.has_greeted = true;
                // The rank itself has greeted the front-end, which has answered with the setup.
                let Some(setup) = self.setup.take() else { return Some(bytes) };
                child.is_set_up = true;
                child.renderer.send(&setup);
            }
            Ok(FromBackend::Ready(_)) => {
                self.restarts.ready(Instant::now());
                return Some(bytes);
            }
            Ok(FromBackend::Drawn(_)) => {
                self.has_drawn = true;
                return Some(bytes);
            }
            Ok(FromBackend::Failed(_)) if !self.has_drawn => {
                self.state = State::Over;
                return Some(bytes);
            }
            Ok(FromBackend::Failed(sentence)) => self.end(Some(format!("failed: {sentence}"))),
            Ok(_) => return Some(bytes),
        }
        None
    }

    fn look_for_hang(&mut self) {
        let State::Running(child) = &mut self.state else { return };
        let silence = child.renderer.silence();
        let limit = if child.has_greeted { HANGS_AFTER } else { STARTS_WITHIN };
        if silence > limit {
            let seconds = limit.as_secs_f64();
            self.end(Some(format!("gave no sign of life for {seconds} s, so it was killed")));
        } else if child.has_greeted && !child.is_asked && silence > ASK_AFTER {
            child.is_asked = true;
            if let Ok(question) = encode(&OWN_QUESTION) {
                child.renderer.send(&question);
            }
        }
    }

    /// Has the renderer end that runs.
    fn end(&mut self, why: Option<String>) {
        self.state = match std::mem::replace(&mut self.state, State::Over) {
            State::Running(mut child) => {
                // One that has closed its stream may still run.
                child.renderer.kill();
                State::Ending(child.renderer, why)
            }
            other => other,
        };
    }

    /// There is no renderer any more: what to tell the front-end. Before any frame was drawn that ends the run, as anything
    /// that is wrong at its beginning.
    fn lose(&mut self, why: String) -> Option<Vec<u8>> {
        let now = Instant::now();
        let wait = self.restarts.ended(now);
        let (state, message) = match self.has_drawn {
            true => {
                let note = self.restarts.note().unwrap_or_default();
                (State::Waiting(now + wait), FromBackend::Lost(why + &note))
            }
            false => (State::Over, FromBackend::Failed(why)),
        };
        self.state = state;
        encode(&message).ok()
    }

    fn start(&mut self) -> Option<Vec<u8>> {
        match (self.command)().and_then(Renderer::start) {
            Ok(renderer) => {
                let [has_greeted, is_set_up, is_asked] = [false; 3];
                self.state = State::Running(Child { renderer, has_greeted, is_set_up, is_asked });
                None
            }
            Err(error) => self.lose(format!("its renderer could not be started: {error}")),
        }
    }

    /// Lets the renderer go: asks it to quit, and kills it if it does not.
    pub fn part(mut self) {
        let State::Running(child) = &mut self.state else { return };
        let Ok(quit) = encode(&FromFrontend::Quit) else { return };
        child.renderer.send(&quit);
        let since = Instant::now();
        // What it still says is for nobody, but it must not wait for room to say it.
        while since.elapsed() < PARTING && child.renderer.silence() < HANGS_AFTER {
            if let Heard::End = child.renderer.receive(Duration::from_millis(10)) {
                return;
            }
        }
    }
}

fn name(process: u32, how: &str) -> String {
    format!("its renderer (process {process}) {how}")
}

fn rest<T>(timeout: Duration) -> Option<T> {
    match timeout {
        Duration::ZERO => std::thread::yield_now(),
        timeout => std::thread::sleep(timeout),
    }
    None
}

#[cfg(test)]
#[path = "keeper_tests.rs"]
mod tests;
