//! The thread of a back-end that shows frames when they are due.

use super::stage::Stage;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, unbounded};
use protocol::{ScreenPicture, Wall, WallError};
use std::collections::BTreeMap;
use std::sync::LazyLock;
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// The clock of this process.
static START: LazyLock<Instant> = LazyLock::new(Instant::now);

/// How often windows are looked after.
const TEND_INTERVAL: Duration = Duration::from_millis(200);

/// So long before a frame is due the thread wakes, and only dozes from then on: who sleeps soundly may wake a millisecond late,
/// each back-end by another time. Who does not sleep at all takes the core from back-ends that share it, for longer than that.
const WAKES_BEFORE: Duration = Duration::from_millis(1);

/// The length of a doze.
const DOZE: Duration = Duration::from_micros(50);

/// What the clock of this process says, microseconds.
pub fn now_us() -> u64 {
    START.elapsed().as_micros() as u64
}

/// What the messages' thread tells it.
enum Cue {
    Wall(Box<dyn Wall>),
    Picture(ScreenPicture),
    Drawn(u32),
    Asked,
    Show { frame: u32, at_us: u64 },
}

/// What it tells the messages' thread.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Told {
    /// A frame is shown.
    Shown {
        /// Its number.
        frame: u32,
        /// Since when, on this process's clock, microseconds.
        at_us: u64,
    },
    /// Something has happened to the windows: a sentence.
    Said(String),
    /// Nothing can be shown any more: a sentence.
    Failed(String),
}

/// The messages' thread's handle on it.
pub struct ShowThread {
    cues: Option<Sender<Cue>>,
    told: Receiver<Told>,
    thread: Option<JoinHandle<()>>,
}

impl ShowThread {
    /// Starts it.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn start() -> std::io::Result<Self> {
        let (cues, inbox) = unbounded();
        let (outbox, told) = unbounded();
        let thread = Builder::new().name("showing".to_owned()).spawn(move || run(&inbox, &outbox))?;
        Ok(Self { cues: Some(cues), told, thread: Some(thread) })
    }

    /// Pictures are shown on this from now on.
    pub fn equip(&self, wall: Box<dyn Wall>) {
        self.cue(Cue::Wall(wall));
    }

    /// A picture of the frame that is being drawn.
    pub fn draw(&self, picture: ScreenPicture) {
        self.cue(Cue::Picture(picture));
    }

    /// A frame is drawn.
    pub fn drawn(&self, frame: u32) {
        self.cue(Cue::Drawn(frame));
    }

    /// Another frame is asked for.
    pub fn asked(&self) {
        self.cue(Cue::Asked);
    }

    /// A frame is to be shown, at a time on this process's clock or as soon as it can be.
    pub fn show(&self, frame: u32, at_us: Option<u64>) {
        self.cue(Cue::Show { frame, at_us: at_us.unwrap_or(0) });
    }

    /// What it has to tell.
    pub fn told(&self) -> &Receiver<Told> {
        &self.told
    }

    fn cue(&self, cue: Cue) {
        // The thread ends when this handle is dropped, and not before.
        let _ = self.cues.as_ref().map(|cues| cues.send(cue));
    }
}

impl Drop for ShowThread {
    fn drop(&mut self) {
        self.cues = None;
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// The windows, and the pictures on their way there.
#[derive(Default)]
struct Windows {
    wall: Option<Box<dyn Wall>>,
    /// Of the frame that is being drawn.
    coming: Vec<ScreenPicture>,
    /// Of frames that wait to be shown.
    drawn: BTreeMap<u32, Vec<ScreenPicture>>,
    ready: Option<u32>,
}

impl Windows {
    fn drawn(&mut self, frame: u32) {
        let pictures = std::mem::take(&mut self.coming);
        if self.wall.is_some() {
            self.drawn.insert(frame, pictures);
        }
    }

    fn ready(&mut self, frame: u32) -> Result<(), WallError> {
        if let (Some(wall), true) = (&mut self.wall, self.ready != Some(frame)) {
            wall.ready(&self.drawn.remove(&frame).unwrap_or_default())?;
            self.ready = Some(frame);
        }
        Ok(())
    }

    fn show(&mut self, frame: u32) -> Result<(), WallError> {
        self.ready(frame)?;
        self.drawn.retain(|&drawn, _| drawn > frame);
        self.wall.as_mut().map_or(Ok(()), |wall| wall.show())
    }
}

fn run(inbox: &Receiver<Cue>, outbox: &Sender<Told>) {
    if let Err(WallError(sentence)) = serve(inbox, outbox) {
        tell(outbox, Told::Failed(sentence));
        // Until somebody ends this.
        inbox.iter().for_each(drop);
    }
}

/// Nobody may want to know any more.
fn tell(outbox: &Sender<Told>, told: Told) {
    let _ = outbox.send(told);
}

fn serve(inbox: &Receiver<Cue>, outbox: &Sender<Told>) -> Result<(), WallError> {
    let (mut stage, mut windows) = (Stage::default(), Windows::default());
    let mut tended = Instant::now();
    loop {
        // Also where a frame is always due, as with a window system that takes longer to show one than others take to come.
        if let (Some(wall), true) = (&mut windows.wall, tended.elapsed() >= TEND_INTERVAL) {
            wall.tend()?.into_iter().for_each(|sentence| tell(outbox, Told::Said(sentence)));
            tended = Instant::now();
        }
        let mut wait = windows.wall.as_ref().map(|_| TEND_INTERVAL.saturating_sub(tended.elapsed()));
        if let Some((frame, when)) = stage.due(now_us()) {
            let left = Duration::from_micros(when.saturating_sub(now_us()));
            if left.is_zero() {
                windows.show(frame)?;
                stage.shown(frame);
                tell(outbox, Told::Shown { frame, at_us: now_us() });
                // Of those that have come meanwhile, the newest is next.
                inbox.try_iter().for_each(|cue| take(cue, &mut stage, &mut windows));
                continue;
            }
            let sleep = left.saturating_sub(WAKES_BEFORE).max(left.min(DOZE));
            wait = Some(wait.map_or(sleep, |wait| wait.min(sleep)));
        }
        if let Some(frame) = stage.next(now_us()) {
            windows.ready(frame)?;
        }
        let cue = match wait {
            Some(wait) => inbox.recv_timeout(wait),
            None => inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
        };
        match cue {
            Ok(cue) => take(cue, &mut stage, &mut windows),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
    }
}

fn take(cue: Cue, stage: &mut Stage, windows: &mut Windows) {
    match cue {
        Cue::Wall(wall) => windows.wall = Some(wall),
        Cue::Picture(picture) => windows.coming.push(picture),
        Cue::Drawn(frame) => {
            windows.drawn(frame);
            stage.drawn(frame);
        }
        Cue::Asked => {
            stage.asked();
            windows.drawn.retain(|&frame, _| stage.awaits(frame));
        }
        Cue::Show { frame, at_us } => stage.order(frame, at_us),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::ScreenImage;
    use std::sync::{Arc, Mutex};

    fn next(thread: &ShowThread) -> Told {
        thread.told().recv_timeout(Duration::from_secs(10)).unwrap()
    }

    #[test]
    fn a_frame_is_never_shown_before_its_time() {
        let thread = ShowThread::start().unwrap();
        let at_us = now_us() + 20_000;
        thread.drawn(7);
        thread.show(7, Some(at_us));
        let Told::Shown { frame, at_us: shown_us } = next(&thread) else { panic!("it is shown") };
        assert_eq!(frame, 7);
        assert!(shown_us >= at_us, "{shown_us}, due at {at_us}");
    }

    /// What a wall was asked to do.
    #[derive(Clone, Default)]
    struct Fake(Arc<Mutex<Vec<String>>>);

    impl Wall for Fake {
        fn ready(&mut self, pictures: &[ScreenPicture]) -> Result<(), WallError> {
            let images = pictures.iter().filter_map(ScreenPicture::on_host);
            let projectors: Vec<u32> = images.map(|image| image.projector).collect();
            self.0.lock().unwrap().push(format!("ready {projectors:?}"));
            Ok(())
        }

        fn show(&mut self) -> Result<(), WallError> {
            self.0.lock().unwrap().push("show".to_owned());
            Ok(())
        }

        /// It fails once two frames are shown.
        fn tend(&mut self) -> Result<Vec<String>, WallError> {
            match self.0.lock().unwrap().iter().filter(|line| *line == "show").count() {
                2 => Err(WallError("the server is gone".to_owned())),
                _ => Ok(Vec::new()),
            }
        }
    }

    /// One whose window system takes its time.
    struct Slow(Duration);

    impl Wall for Slow {
        fn ready(&mut self, _: &[ScreenPicture]) -> Result<(), WallError> {
            Ok(())
        }

        fn show(&mut self) -> Result<(), WallError> {
            std::thread::sleep(self.0);
            Ok(())
        }

        fn tend(&mut self) -> Result<Vec<String>, WallError> {
            Ok(vec!["a window has closed".to_owned()])
        }
    }

    #[test]
    fn a_slow_window_system_leaves_frames_out_never_falls_behind_and_is_looked_after() {
        let thread = ShowThread::start().unwrap();
        thread.equip(Box::new(Slow(Duration::from_millis(100))));
        let last = 39;
        for frame in 0..=last {
            thread.drawn(frame);
            thread.show(frame, None);
            std::thread::sleep(Duration::from_millis(10));
        }
        let since = Instant::now();
        let (mut shown, mut said) = (0, 0);
        loop {
            match next(&thread) {
                Told::Shown { frame, .. } if frame == last => break,
                Told::Shown { .. } => shown += 1,
                _ => said += 1,
            }
        }
        // What it is at when the last frame comes, and that one; all others would take four seconds.
        assert!(since.elapsed() < Duration::from_secs(1) && shown < last, "{:?}, {shown}", since.elapsed());
        assert!(said > 0, "what has happened is told while frames are due without a pause");
    }

    #[test]
    fn pictures_are_readied_ahead_and_shown_with_their_frame() {
        let (thread, wall) = (ShowThread::start().unwrap(), Fake::default());
        thread.equip(Box::new(wall.clone()));
        let image =
            |projector| ScreenPicture::Host(ScreenImage { projector, width: 1, height: 1, rgb: vec![0; 3] });
        for frame in 0..3 {
            thread.draw(image(10 + frame));
            thread.drawn(frame);
        }
        // Frame 1 is left out, because the order for frame 2 has come as well.
        thread.show(0, None);
        assert!(matches!(next(&thread), Told::Shown { frame: 0, .. }));
        // An order that came before it was ready would find it left out already.
        let since = Instant::now();
        while !wall.0.lock().unwrap().contains(&"ready [11]".to_owned()) {
            assert!(since.elapsed() < Duration::from_secs(10), "frame 1 is readied");
            std::thread::yield_now();
        }
        thread.show(2, None);
        assert!(matches!(next(&thread), Told::Shown { frame: 2, .. }));
        assert_eq!(
            *wall.0.lock().unwrap(),
            ["ready [10]", "show", "ready [11]", "ready [12]", "show"],
            "frame 1 was readied, and gave its place to frame 2"
        );
        assert_eq!(next(&thread), Told::Failed("the server is gone".to_owned()));
    }
}
