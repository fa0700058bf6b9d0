//! The thread of a back-end that draws.

use super::beat::now_us;
use super::opened::Opened;
use crossbeam_channel::{Receiver, Sender, TryRecvError, bounded, unbounded};
use protocol::{CodesAt, DrawError, FrameState, FromBackend, Render, ScreenPicture, Screens, Setup, Wall};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// What the messages' thread asks of it.
pub(super) enum Command {
    /// Open the volume and the device.
    Open(Box<Setup>),
    /// Draw this frame, and drop one that is not done.
    Draw(Box<FrameState>),
    /// Draw this frame for the screens once the one before is done, and drop one that waits.
    Beat(Asked),
    /// Complete what is written beside the pictures.
    Finish,
}

/// A frame of the beat.
pub(super) struct Asked {
    pub(super) frame: Box<FrameState>,
    /// What it is compared with.
    pub(super) newest: Option<Box<FrameState>>,
}

impl Asked {
    /// Begins it.
    fn begin(&self, renderer: &mut dyn Render) -> Result<(), DrawError> {
        renderer.restart(&self.frame)?;
        self.newest.iter().for_each(|newest| renderer.compare_with(newest));
        Ok(())
    }
}

/// What it has to say.
pub(super) enum Reply {
    /// Pass this on.
    Message {
        /// To the front-end.
        message: FromBackend,
        /// Commands for which it owes nothing any more; a frame that another takes the place of is owed no longer.
        answered: u64,
    },
    /// Show pictures on this from now on.
    Wall(Box<dyn Wall>),
    /// A picture of the frame that it draws, for the wall.
    Picture(ScreenPicture),
    /// It cannot go on: one sentence.
    Failed(String),
}

/// Replies it may be ahead of the messages' thread: few, because each may be a picture.
const MOST_AHEAD: usize = 2;

/// Progress is reported this often while a frame is drawn.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);

/// What it holds is told this often, after a frame of the beat.
const HELD_INTERVAL: Duration = Duration::from_millis(if cfg!(test) { 50 } else { 1000 });

/// The messages' thread's handle on it. Dropped, it has the thread leave off and waits until the renderer is gone.
pub(super) struct RenderThread {
    commands: Option<Sender<Command>>,
    replies: Option<Receiver<Reply>>,
    is_over: Arc<AtomicBool>,
    stepped_us: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl RenderThread {
    /// Starts it; it opens its renderer with `make`.
    ///
    /// # Errors
    /// The system has no thread left.
    pub(super) fn start<M>(make: M) -> std::io::Result<Self>
    where
        M: FnOnce(Setup) -> Result<Opened, String> + Send + 'static,
    {
        let (commands, inbox) = unbounded();
        let (outbox, replies) = bounded(MOST_AHEAD);
        let (is_over, stepped_us) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(now_us())));
        let studio = Studio {
            inbox,
            outbox,
            is_over: Arc::clone(&is_over),
            stepped_us: Arc::clone(&stepped_us),
            taken: 0,
            screens: Screens::default(),
            wants: CodesAt::HOST,
            told_at: Instant::now(),
        };
        let thread = Builder::new().name("drawing".to_owned()).spawn(move || studio.run(make))?;
        Ok(Self {
            commands: Some(commands),
            replies: Some(replies),
            is_over,
            stepped_us,
            thread: Some(thread),
        })
    }

    /// Asks something of it; what it is drawing is left off after the present tile.
    pub(super) fn command(&self, command: Command) {
        // A thread that has ended has failed, and said so in a reply.
        let _ = self.commands.as_ref().map(|commands| commands.send(command));
    }

    /// It is asked something after it had nothing to do.
    pub(super) fn wake(&self) {
        self.stepped_us.fetch_max(now_us(), Ordering::Relaxed);
    }

    /// For how long it has taken no command and finished no tile, since it was woken; opening a volume may take any time.
    pub(super) fn stands_still_for(&self) -> Duration {
        Duration::from_micros(now_us().saturating_sub(self.stepped_us.load(Ordering::Relaxed)))
    }

    /// Where its replies come.
    pub(super) fn replies(&self) -> &Receiver<Reply> {
        self.replies.as_ref().expect("they are only taken away when it is dropped")
    }
}

impl Drop for RenderThread {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        // Without these it waits for nothing and nobody any more.
        drop((self.commands.take(), self.replies.take()));
        // Its panics are caught inside and reported.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// The thread itself.
struct Studio {
    inbox: Receiver<Command>,
    outbox: Sender<Reply>,
    is_over: Arc<AtomicBool>,
    /// When it last took a command or finished a tile.
    stepped_us: Arc<AtomicU64>,
    /// Commands that it has begun with.
    taken: u64,
    /// Where the pictures of the beat go.
    screens: Screens,
    /// Where their codes are wanted for that.
    wants: CodesAt,
    /// When it last told what it holds.
    told_at: Instant,
}

/// What a studio is at.
enum Work {
    /// Nothing.
    Idle,
    /// A frame that another takes the place of.
    Frame,
    /// A frame of the beat; the next one waits.
    Beat { next: Option<Asked> },
}

/// Why the thread ends.
enum End {
    /// Nobody listens any more.
    Dismissed,
    /// It cannot go on.
    Failed(String),
}

impl From<DrawError> for End {
    fn from(error: DrawError) -> Self {
        Self::Failed(error.to_string())
    }
}

impl Studio {
    fn run<M>(mut self, make: M)
    where
        M: FnOnce(Setup) -> Result<Opened, String>,
    {
        let ended = catch_unwind(AssertUnwindSafe(|| self.work(make)));
        let sentence = match ended {
            Ok(Ok(()) | Err(End::Dismissed)) => return,
            Ok(Err(End::Failed(sentence))) => sentence,
            Err(panic) => panic_sentence(panic.as_ref()),
        };
        let _ = self.outbox.send(Reply::Failed(sentence));
    }

    fn work<M>(&mut self, make: M) -> Result<(), End>
    where
        M: FnOnce(Setup) -> Result<Opened, String>,
    {
        let Ok(Command::Open(setup)) = self.inbox.recv() else { return Ok(()) };
        (self.taken, self.screens) = (1, setup.screens);
        self.stepped_us.store(u64::MAX, Ordering::Relaxed);
        let Opened { mut renderer, device, wall } = make(*setup).map_err(End::Failed)?;
        self.step();
        let is_painted = wall.as_ref().is_some_and(|wall| wall.is_painted());
        self.wants = CodesAt { host: self.screens.frontend || !is_painted, device: is_painted };
        if let Some(wall) = wall {
            self.outbox.send(Reply::Wall(wall)).map_err(|_| End::Dismissed)?;
        }
        self.tell(FromBackend::Ready(device), true)?;
        let ended = self.obey(renderer.as_mut());
        if let Err(End::Dismissed) = ended {
            // Whoever ended the run wants what was written until then. Nobody is left to hear why that fails.
            let _ = renderer.finish();
        }
        ended
    }

    /// Does what it is asked to, until nobody asks any more.
    fn obey(&mut self, renderer: &mut dyn Render) -> Result<(), End> {
        let mut work = Work::Idle;
        loop {
            let command = self.next(!matches!(work, Work::Idle))?;
            work = match (command, work) {
                (Some(Command::Draw(frame)), _) => {
                    renderer.restart(&frame)?;
                    Work::Frame
                }
                (Some(Command::Beat(asked)), Work::Beat { .. }) => Work::Beat { next: Some(asked) },
                (Some(Command::Beat(asked)), Work::Idle | Work::Frame) => {
                    asked.begin(renderer)?;
                    Work::Beat { next: None }
                }
                (Some(Command::Finish), _) => {
                    renderer.finish()?;
                    self.tell(FromBackend::Finished, true)?;
                    Work::Idle
                }
                (Some(Command::Open(_)), _) => return Err(End::Failed("it was set up twice".to_owned())),
                (None, Work::Beat { next }) => self.go_on_beating(renderer, next)?,
                (None, Work::Frame) if !self.go_on(renderer)? => Work::Frame,
                (None, Work::Frame | Work::Idle) => Work::Idle,
            };
        }
    }

    /// The next command; None where there is none and something to draw.
    fn next(&mut self, is_drawing: bool) -> Result<Option<Command>, End> {
        let command = match is_drawing {
            true => self.inbox.try_recv(),
            false => self.inbox.recv().map_err(|_| TryRecvError::Disconnected),
        };
        match command {
            Ok(command) => {
                self.step();
                self.taken += 1;
                Ok(Some(command))
            }
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(End::Dismissed),
        }
    }

    /// Goes on with a frame of the beat until it is done or a command comes, and begins the next.
    fn go_on_beating(&mut self, renderer: &mut dyn Render, next: Option<Asked>) -> Result<Work, End> {
        let advance = renderer.advance(&|| self.has_command())?;
        let mut sent = Ok(());
        renderer.present_on_screens(self.wants, &mut |picture| {
            if sent.is_ok() {
                sent = self.show(picture);
            }
        })?;
        sent?;
        let Some(report) = advance.report else { return Ok(Work::Beat { next }) };
        if self.told_at.elapsed() > HELD_INTERVAL {
            self.told_at = Instant::now();
            renderer.held().map_or(Ok(()), |held| self.tell(FromBackend::Held(Box::new(held)), false))?;
        }
        self.tell(FromBackend::Drawn(report), next.is_none())?;
        let Some(asked) = next else { return Ok(Work::Idle) };
        asked.begin(renderer)?;
        Ok(Work::Beat { next: None })
    }

    /// Goes on with the frame until it is done, a command comes, or it is time for news. Whether it is done.
    fn go_on(&self, renderer: &mut dyn Render) -> Result<bool, End> {
        let since = Instant::now();
        let advance = renderer.advance(&|| self.has_command() || since.elapsed() > PROGRESS_INTERVAL)?;
        let mut sent = Ok(());
        renderer.present(&mut |image| {
            if sent.is_ok() {
                sent = self.tell(FromBackend::Image(image), false);
            }
        })?;
        sent?;
        self.tell(FromBackend::Progress { done: advance.done, total: advance.total }, false)?;
        let Some(report) = advance.report else { return Ok(false) };
        self.tell(FromBackend::Done(report), true)?;
        Ok(true)
    }

    /// Asked before each tile: whether something else is to be done.
    fn has_command(&self) -> bool {
        self.step();
        !self.inbox.is_empty() || self.is_over.load(Ordering::Relaxed)
    }

    fn step(&self) {
        self.stepped_us.store(now_us(), Ordering::Relaxed);
    }

    /// Sends a picture of the beat where it is wanted.
    fn show(&self, picture: ScreenPicture) -> Result<(), End> {
        let onto_wall = |picture| self.outbox.send(Reply::Picture(picture)).map_err(|_| End::Dismissed);
        match picture {
            ScreenPicture::Device(_) => onto_wall(picture),
            ScreenPicture::Host(image) => match (self.screens.outputs && !self.wants.device, self.screens) {
                (false, Screens { frontend: false, .. }) => Ok(()),
                (true, Screens { frontend: false, .. }) => onto_wall(ScreenPicture::Host(image)),
                (is_for_wall, Screens { frontend: true, .. }) => {
                    if is_for_wall {
                        onto_wall(ScreenPicture::Host(image.clone()))?;
                    }
                    self.tell(FromBackend::Screen(image), false)
                }
            },
        }
    }

    fn tell(&self, message: FromBackend, is_answer: bool) -> Result<(), End> {
        let answered = if is_answer { self.taken } else { self.taken - 1 };
        self.outbox.send(Reply::Message { message, answered }).map_err(|_| End::Dismissed)
    }
}

/// What a panic says, as a sentence.
pub(super) fn panic_sentence(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
    format!("it panicked: {text}; this is a fault in lightloom, please report it with this line")
}
