//! A frame that another takes the place of, while it is drawn; a back-end that takes the place of another.

use crate::Opened;
use crate::session_fixtures::{device, device_after, frame, held, report, setups};
use crate::threads;
use crate::{Link, LinkError};
use protocol::{
    Advance, CodesAt, DrawError, FrameState, FromBackend, FromFrontend, Held, ProjectorImage, Render,
    ScreenPicture, Setup, StopAsked,
};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Long against the thread switches and looks at the link between two messages.
const TILE: Duration = Duration::from_millis(30);

/// The numbers of the frames whose tiles were cast, in order.
type Cast = Arc<Mutex<Vec<u32>>>;

/// Casts a tile every 30 ms; frame 0 has so many that it takes minutes. It looks whether to stop every so many tiles.
struct Slow {
    frame: u32,
    left: u32,
    patience: u32,
    cast: Cast,
}

impl Render for Slow {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        (self.frame, self.left) = (frame.index, if frame.index == 0 { 10_000 } else { 2 });
        Ok(())
    }

    fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError> {
        while self.left > 0 && !(self.left.is_multiple_of(self.patience) && stop()) {
            std::thread::sleep(TILE);
            self.cast.lock().unwrap().push(self.frame);
            self.left -= 1;
        }
        let report = (self.left == 0).then(|| Box::new(report(self.frame, 0)));
        Ok(Advance { done: 1, total: 1, lacking_bricks: 0, report })
    }

    fn present(&mut self, _: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        Ok(())
    }
    fn present_on_screens(&mut self, _: CodesAt, _: &mut dyn FnMut(ScreenPicture)) -> Result<(), DrawError> {
        Ok(())
    }
}

/// The next message of the only back-end that is no news of progress.
fn answer(link: &mut dyn Link) -> FromBackend {
    loop {
        match link.receive(Duration::from_secs(20)) {
            Ok((_, FromBackend::Progress { .. } | FromBackend::Hello(_) | FromBackend::Alive)) => {}
            Ok((_, message)) => return message,
            Err(error) => panic!("{error}"),
        }
    }
}

/// Tiles of frame 0 that were begun or done after frame 1 was sent.
fn tiles_after_restart(patience: u32) -> usize {
    let cast = Cast::default();
    let seen = Arc::clone(&cast);
    let open = move |_: Setup| -> Result<Opened, String> {
        let slow = Slow { frame: 0, left: 0, patience, cast: Arc::clone(&cast) };
        Ok(Opened::new(Box::new(slow), device()))
    };
    let mut link = threads::spawn(1, open).unwrap();
    let send = |link: &mut threads::ThreadLink, message| link.send(0, &message).unwrap();
    send(&mut link, FromFrontend::Setup(Box::new(setups(1).remove(0))));
    assert_eq!(answer(&mut link), FromBackend::Ready(device()));
    send(&mut link, FromFrontend::Frame(Box::new(frame(0))));
    while seen.lock().unwrap().len() < 3 {
        std::thread::sleep(Duration::from_millis(1));
    }
    let before = seen.lock().unwrap().len();
    send(&mut link, FromFrontend::Frame(Box::new(frame(1))));
    assert_eq!(answer(&mut link), FromBackend::Done(Box::new(report(1, 0))));
    send(&mut link, FromFrontend::Quit);
    link.finish().unwrap();
    let tiles = seen.lock().unwrap();
    assert!(tiles.ends_with(&[1, 1]));
    tiles[before..].iter().filter(|&&frame| frame == 0).count()
}

/// The tile that is being cast when the message is sent is finished; a second one may begin while the message travels.
#[test]
fn a_restart_reaches_a_back_end_that_is_busy_within_a_tile() {
    let tiles = tiles_after_restart(1);
    assert!(tiles <= 2, "{tiles}");
    let canary = tiles_after_restart(10);
    assert!(canary > 2, "a renderer that seldom looks whether to stop would pass: {canary}");
}

#[test]
fn a_busy_back_end_quits_within_a_tile() {
    let cast = Cast::default();
    let seen = Arc::clone(&cast);
    let open = move |_: Setup| -> Result<Opened, String> {
        Ok(Opened::new(Box::new(Slow { frame: 0, left: 0, patience: 1, cast: Arc::clone(&cast) }), device()))
    };
    let mut link = threads::spawn(1, open).unwrap();
    link.send(0, &FromFrontend::Setup(Box::new(setups(1).remove(0)))).unwrap();
    link.send(0, &FromFrontend::Frame(Box::new(frame(0)))).unwrap();
    while seen.lock().unwrap().is_empty() {
        std::thread::sleep(Duration::from_millis(1));
    }
    link.send(0, &FromFrontend::Quit).unwrap();
    assert_eq!(link.finish(), Ok::<(), LinkError>(()));
    assert!(seen.lock().unwrap().len() < 10);
}

/// Panics in frame 2, and holds something before.
struct Fragile(u32);

impl Render for Fragile {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        self.0 = frame.index;
        Ok(())
    }

    fn advance(&mut self, _: StopAsked) -> Result<Advance, DrawError> {
        assert_ne!(self.0, 2, "a fault");
        Ok(Advance { done: 1, total: 1, lacking_bricks: 0, report: Some(Box::new(report(self.0, 0))) })
    }

    fn present(&mut self, _: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        Ok(())
    }

    fn present_on_screens(&mut self, _: CodesAt, _: &mut dyn FnMut(ScreenPicture)) -> Result<(), DrawError> {
        Ok(())
    }

    fn held(&mut self) -> Option<Held> {
        Some(held())
    }
}

#[test]
fn a_thread_that_comes_back_knows_what_the_one_before_it_showed() {
    let open = |setup: Setup| Ok(Opened::new(Box::new(Fragile(0)), device_after(setup.held)));
    let mut link = threads::spawn(1, open).unwrap();
    let setup = FromFrontend::Setup(Box::new(setups(1).remove(0)));
    link.send(0, &setup).unwrap();
    assert_eq!(answer(&mut link), FromBackend::Ready(device()));
    // It is told after a while.
    std::thread::sleep(Duration::from_millis(100));
    let beat = |index| FromFrontend::Beat { frame: Box::new(frame(index)), newest: None };
    link.send(0, &beat(1)).unwrap();
    assert_eq!(answer(&mut link), FromBackend::Drawn(Box::new(report(1, 0))));
    link.send(0, &beat(2)).unwrap();
    let FromBackend::Failed(why) = answer(&mut link) else { panic!("it goes on") };
    assert!(why.contains("a fault"), "{why}");
    assert_eq!(link.revive(0), Ok(true));
    link.send(0, &setup).unwrap();
    let said = loop {
        match link.receive(Duration::from_secs(20)) {
            // The last of the one before it, and the first of this one.
            Err(LinkError::Ended { .. }) | Ok((_, FromBackend::Hello(_) | FromBackend::Alive)) => {}
            said => break said,
        }
    };
    assert_eq!(said, Ok((0, FromBackend::Ready(device_after(Some(Box::new(held())))))));
    link.send(0, &FromFrontend::Quit).unwrap();
    link.finish().unwrap();
}
