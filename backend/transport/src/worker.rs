//! The life of a back-end: one thread passes messages on, another draws. So messages reach a back-end that is busy.

use super::beat::{ShowThread, Told, now_us};
use super::link::{LinkError, WorkerLink};
use super::opened::Opened;
use super::process;
use super::render_loop::{Asked, Command, RenderThread, Reply};
use crossbeam_channel::select;
use protocol::{FromBackend, FromFrontend, Hello, PROTOCOL_VERSION, Setup};
use std::time::{Duration, Instant};

/// Why a back-end stopped before it was asked to.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WorkerError {
    /// The front-end cannot be reached.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The front-end has said nothing for too long.
    #[error("the front-end has said nothing for {0} s, so this back-end ends; look there for the cause")]
    FrontendSilent(u64),
    /// It could not go on; the front-end knows the sentence and shows it.
    #[error("{0}")]
    Failed(String),
}

/// How long a back-end that failed stays for the front-end to read why. Were it gone at once, the launcher could end
/// the job before the sentence is shown.
const LAST_WORDS: Duration = Duration::from_secs(5);

/// How long the messages' thread waits for the renderer before it looks at the link, while there is something to draw.
const LOOK_INTERVAL: Duration = Duration::from_millis(1);

const THREAD_ENDED: &str = "the thread that draws has ended; please report it with this line";

/// Whoever draws no tile for so long is stuck, in a driver or on a disk. The slowest thing between two tiles is a driver in
/// software that compiles a kernel: seconds.
const STUCK_AFTER: Duration = Duration::from_secs(if cfg!(test) { 2 } else { 60 });

/// How often a back-end with something to do says that it lives, while it has nothing else to say.
const ALIVE_INTERVAL: Duration = Duration::from_millis(250);

/// Serves one front-end until it says Quit. `make` opens the renderer, in the thread that draws, once the setup is known.
/// Errors and panics of the renderer reach the front-end as one sentence.
pub fn serve<M>(link: &mut dyn WorkerLink, make: M) -> Result<(), WorkerError>
where
    M: FnOnce(Setup) -> Result<Opened, String> + Send + 'static,
{
    greet(link)?;
    attend(link, make)
}

/// Says hello.
pub(super) fn greet(link: &mut dyn WorkerLink) -> Result<(), LinkError> {
    let (host, process) = (process::host(), std::process::id());
    link.send(FromBackend::Hello(Hello { protocol: PROTOCOL_VERSION, host, process }))
}

/// Serves a front-end that was greeted.
pub(super) fn attend<M>(link: &mut dyn WorkerLink, make: M) -> Result<(), WorkerError>
where
    M: FnOnce(Setup) -> Result<Opened, String> + Send + 'static,
{
    let renderer = match RenderThread::start(make) {
        Ok(renderer) => renderer,
        Err(error) => {
            return fail(
                link,
                format!("no thread could be started to draw with: {error}; start fewer back-ends"),
            );
        }
    };
    let screens = match ShowThread::start() {
        Ok(screens) => screens,
        Err(error) => {
            return fail(
                link,
                format!("no thread could be started to show with: {error}; start fewer back-ends"),
            );
        }
    };
    let mut desk = Desk {
        link,
        renderer,
        screens,
        is_set_up: false,
        asked: 0,
        answered: 0,
        ordered: None,
        last_said: Instant::now(),
    };
    loop {
        let Some(message) = desk.next()? else { continue };
        let command = match message {
            FromFrontend::Alive => continue,
            FromFrontend::Quit => return Ok(()),
            FromFrontend::Clock { asked_us } => {
                desk.say(FromBackend::Clock { asked_us, here_us: now_us() })?;
                continue;
            }
            FromFrontend::Show { frame, at_us } => {
                desk.screens.show(frame, at_us);
                desk.ordered = desk.ordered.max(Some(frame));
                continue;
            }
            FromFrontend::Setup(_) if desk.is_set_up => return desk.fail("it was set up twice".to_owned()),
            FromFrontend::Setup(setup) => {
                desk.is_set_up = true;
                Command::Open(setup)
            }
            FromFrontend::Frame(_) | FromFrontend::Beat { .. } if !desk.is_set_up => {
                return desk.fail("a frame came before the setup".to_owned());
            }
            FromFrontend::Frame(frame) => Command::Draw(frame),
            FromFrontend::Beat { frame, newest } => {
                desk.screens.asked();
                Command::Beat(Asked { frame, newest })
            }
            FromFrontend::Finish if !desk.is_set_up => {
                return desk.fail("its end came before the setup".to_owned());
            }
            FromFrontend::Finish => Command::Finish,
        };
        if desk.is_idle() {
            desk.renderer.wake();
        }
        desk.asked += 1;
        desk.renderer.command(command);
    }
}

/// The messages' side of a back-end.
struct Desk<'a> {
    link: &'a mut dyn WorkerLink,
    renderer: RenderThread,
    screens: ShowThread,
    is_set_up: bool,
    /// Commands to the renderer.
    asked: u64,
    /// Those of them that it owes nothing for any more.
    answered: u64,
    /// The latest frame of the beat that is to be shown and is not.
    ordered: Option<u32>,
    /// When it last said anything.
    last_said: Instant,
}

impl Desk<'_> {
    /// Whether the renderer owes nothing.
    fn is_idle(&self) -> bool {
        self.answered == self.asked
    }

    /// The next message of the front-end; None where the renderer had something to say first.
    fn next(&mut self) -> Result<Option<FromFrontend>, WorkerError> {
        if self.is_idle() && self.ordered.is_none() {
            let silence = self.link.frontend_silence();
            return self.link.receive(silence).map(Some).map_err(|error| match error {
                LinkError::Silent => WorkerError::FrontendSilent(silence.as_secs()),
                error => error.into(),
            });
        }
        select! {
            recv(self.renderer.replies()) -> reply => {
                return self.pass_on(reply.unwrap_or_else(|_| Reply::Failed(THREAD_ENDED.to_owned()))).map(|()| None);
            }
            recv(self.screens.told()) -> told => {
                if let Ok(told) = told {
                    return self.pass_on_from_screens(told).map(|()| None);
                }
            }
            default(LOOK_INTERVAL) => {
                if self.is_stuck() {
                    let seconds = STUCK_AFTER.as_secs();
                    let why = "its graphics driver or the disk with the volume is stuck";
                    return self.fail(format!("it has drawn no tile for {seconds} s: {why}")).map(|()| None);
                }
                // The thread that draws may be in a piece of work that takes long.
                if self.last_said.elapsed() > ALIVE_INTERVAL {
                    self.say(FromBackend::Alive)?;
                }
            }
        }
        match self.link.receive(Duration::ZERO) {
            Ok(message) => Ok(Some(message)),
            Err(LinkError::Silent) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// Whether it had better be replaced.
    fn is_stuck(&self) -> bool {
        !self.is_idle() && self.link.can_be_replaced() && self.renderer.stands_still_for() > STUCK_AFTER
    }

    /// What the renderer has to say, to whom it concerns.
    fn pass_on(&mut self, reply: Reply) -> Result<(), WorkerError> {
        match reply {
            Reply::Failed(sentence) => self.fail(sentence),
            Reply::Wall(wall) => {
                self.screens.equip(wall);
                Ok(())
            }
            Reply::Picture(picture) => {
                self.screens.draw(picture);
                Ok(())
            }
            Reply::Message { message, answered } => {
                self.answered = answered;
                if let FromBackend::Drawn(report) = &message {
                    self.screens.drawn(report.frame);
                }
                self.say(message)
            }
        }
    }

    /// What the screens have to say.
    fn pass_on_from_screens(&mut self, told: Told) -> Result<(), WorkerError> {
        match told {
            Told::Shown { frame, at_us } => {
                self.ordered = self.ordered.filter(|&ordered| ordered > frame);
                self.say(FromBackend::Shown { frame, at_us })
            }
            Told::Said(sentence) => self.say(FromBackend::Said(sentence)),
            Told::Failed(sentence) => self.fail(sentence),
        }
    }

    fn say(&mut self, message: FromBackend) -> Result<(), WorkerError> {
        self.link.send(message)?;
        self.last_said = Instant::now();
        Ok(())
    }

    fn fail(&mut self, sentence: String) -> Result<(), WorkerError> {
        fail(self.link, sentence)
    }
}

/// Says why this back-end ends, and gives the front-end time to say so.
fn fail(link: &mut dyn WorkerLink, sentence: String) -> Result<(), WorkerError> {
    link.send(FromBackend::Failed(sentence.clone()))?;
    let since = Instant::now();
    while let Some(left) = LAST_WORDS.checked_sub(since.elapsed()) {
        match link.receive(left) {
            Ok(FromFrontend::Quit) | Err(_) => break,
            Ok(_) => {}
        }
    }
    Err(WorkerError::Failed(sentence))
}
