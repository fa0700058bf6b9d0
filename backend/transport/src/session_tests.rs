//! A session with back-ends in threads, and with back-ends that follow a script.

use super::*;
use crate::Opened;
use crate::session_fixtures::{device, frame, report, setups};
use crate::threads::{self, ThreadLink};
use protocol::{Advance, CodesAt, Hello, ProjectorImage, Render, ScreenPicture, StopAsked};
use std::collections::VecDeque;

/// Long against the interval of signs of life.
const SHORT: Limits = Limits { silence: Duration::from_secs(1), standstill: Duration::from_secs(2) };

fn start(link: Box<dyn Link>, setups: Vec<Setup>) -> Result<Session, SessionError> {
    Session::start(link, setups, SHORT, Arc::default())
}

/// Draws a grey pixel; back-end 1 does `mischief` in frame 1.
struct Fake {
    backend: u32,
    mischief: fn() -> Result<(), String>,
    frame: u32,
    tiles: u64,
}

impl Render for Fake {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        (self.frame, self.tiles) = (frame.index, 0);
        Ok(())
    }

    fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError> {
        if self.backend == 1 && self.frame == 1 {
            (self.mischief)().map_err(DrawError)?;
        }
        while self.tiles < TILES && !stop() {
            self.tiles += 1;
        }
        let report = (self.tiles == TILES).then(|| Box::new(report(self.frame, self.backend)));
        Ok(Advance { done: self.tiles, total: TILES, lacking_bricks: 0, report })
    }

    fn present(&mut self, sink: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        if self.tiles == TILES {
            sink(ProjectorImage { projector: self.backend, width: 1, height: 1, rgba: vec![0.5; 4] });
        }
        Ok(())
    }
    fn present_on_screens(&mut self, _: CodesAt, _: &mut dyn FnMut(ScreenPicture)) -> Result<(), DrawError> {
        Ok(())
    }
}

const TILES: u64 = 1000;

fn threads_with(mischief: fn() -> Result<(), String>) -> Box<ThreadLink> {
    let open = move |setup: Setup| -> Result<Opened, String> {
        Ok(Opened::new(
            Box::new(Fake { backend: setup.options.backend, mischief, frame: 0, tiles: 0 }),
            device(),
        ))
    };
    Box::new(threads::spawn(3, open).unwrap())
}

fn fate_of(mischief: fn() -> Result<(), String>) -> String {
    let mut session = start(threads_with(mischief), setups(3)).unwrap();
    session.render(&frame(0), &mut |_| {}).unwrap();
    session.render(&frame(1), &mut |_| {}).unwrap_err().to_string()
}

#[test]
fn every_back_end_draws_every_frame_and_leaves() {
    let mut session = start(threads_with(|| Ok(())), setups(3)).unwrap();
    assert_eq!(session.devices(), [device(), device(), device()]);
    for index in 0..4 {
        let mut drawn = Vec::new();
        let reports = session.render(&frame(index), &mut |event| {
            if let RenderEvent::Image(image) = event {
                drawn.push(image.projector);
            }
        });
        drawn.sort_unstable();
        assert_eq!(drawn, [0, 1, 2]);
        assert_eq!(reports.unwrap(), [report(index, 0), report(index, 1), report(index, 2)]);
    }
    session.part().unwrap();
}

#[test]
fn a_failing_back_end_is_named_with_its_own_words() {
    let sentence = fate_of(|| Err("the device is lost".to_owned()));
    assert_eq!(
        sentence,
        "back-end 1 (a thread of this process) failed while drawing frame 1: the device is lost"
    );
    let sentence = fate_of(|| panic!("a fake {}", "fault"));
    assert!(sentence.contains("back-end 1") && sentence.contains("panicked: a fake fault"), "{sentence}");
}

#[test]
fn a_stuck_back_end_is_named_after_the_limit() {
    let since = Instant::now();
    let sentence = fate_of(|| {
        std::thread::sleep(Duration::from_secs(20));
        Ok(())
    });
    assert!(sentence.starts_with("back-end 1 ") && sentence.contains("no further for 2 s"), "{sentence}");
    assert!(since.elapsed() < Duration::from_secs(10));
}

/// Several pieces, each longer than a back-end may be silent, and together longer than it may get no further.
#[test]
fn a_picture_may_take_longer_than_any_limit_while_work_goes_on() {
    const PIECE: Duration = Duration::from_millis(1300);
    let lost = fate_of_pieces(3, PIECE);
    assert!(PIECE > SHORT.silence && 3 * PIECE > SHORT.standstill && PIECE < SHORT.standstill);
    assert_eq!(lost, None);
}

/// What ends a run of frames that take so many pieces, each of so long.
fn fate_of_pieces(pieces: u64, each: Duration) -> Option<String> {
    struct Slow(u64, u64, Duration);
    impl Render for Slow {
        fn restart(&mut self, _: &FrameState) -> Result<(), DrawError> {
            self.0 = 0;
            Ok(())
        }
        fn advance(&mut self, _: StopAsked) -> Result<Advance, DrawError> {
            let Self(done, pieces, each) = self;
            std::thread::sleep(*each);
            *done += 1;
            let report = (done == pieces).then(|| Box::new(report(0, 0)));
            Ok(Advance { done: *done, total: *pieces, lacking_bricks: 0, report })
        }
        fn present(&mut self, _: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
            Ok(())
        }
        fn present_on_screens(
            &mut self,
            _: CodesAt,
            _: &mut dyn FnMut(ScreenPicture),
        ) -> Result<(), DrawError> {
            Ok(())
        }
    }
    let open = move |_: Setup| -> Result<Opened, String> {
        Ok(Opened::new(Box::new(Slow(0, pieces, each)), device()))
    };
    let mut session = start(Box::new(threads::spawn(1, open).unwrap()), setups(1)).unwrap();
    session.render(&frame(0), &mut |_| {}).err().map(|error| error.to_string())
}

#[test]
fn a_run_that_is_stopped_leaves_its_frame_and_completes_what_is_written() {
    struct Writing(Arc<AtomicBool>);
    impl Render for Writing {
        fn restart(&mut self, _: &FrameState) -> Result<(), DrawError> {
            Ok(())
        }
        fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError> {
            while !stop() {
                std::thread::sleep(Duration::from_millis(1));
            }
            Ok(Advance { done: 0, total: 1, lacking_bricks: 0, report: None })
        }
        fn present(&mut self, _: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
            Ok(())
        }
        fn present_on_screens(
            &mut self,
            _: CodesAt,
            _: &mut dyn FnMut(ScreenPicture),
        ) -> Result<(), DrawError> {
            Ok(())
        }
        fn finish(&mut self) -> Result<(), DrawError> {
            self.0.store(true, Ordering::SeqCst);
            Ok(())
        }
    }
    let (is_written, stop) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
    let written = Arc::clone(&is_written);
    let open = move |_: Setup| -> Result<Opened, String> {
        Ok(Opened::new(Box::new(Writing(Arc::clone(&written))), device()))
    };
    let link = Box::new(threads::spawn(2, open).unwrap());
    let traced = |setup| Setup { trace: Some("a.trace".into()), ..setup };
    let setups = setups(2).into_iter().map(traced).collect();
    let mut session = Session::start(link, setups, SHORT, Arc::clone(&stop)).unwrap();
    let asked = Arc::clone(&stop);
    let ended = session.render(&frame(4), &mut |_| asked.store(true, Ordering::SeqCst));
    assert_eq!(ended.unwrap_err().to_string(), "stopped by a signal while drawing frame 4");
    assert!(!is_written.load(Ordering::SeqCst));
    session.part().unwrap();
    assert!(is_written.load(Ordering::SeqCst));
}

#[test]
fn as_many_setups_as_back_ends_are_needed() {
    let error = start(threads_with(|| Ok(())), setups(2)).map(drop).unwrap_err();
    assert_eq!(error, SessionError::Count { setups: 2, backends: 3 });
}

/// Two back-ends whose messages are written down beforehand; back-end 0 then reports progress for ever.
struct Script(VecDeque<(usize, FromBackend)>);

impl Link for Script {
    fn backends(&self) -> usize {
        2
    }
    fn name(&self, backend: usize) -> String {
        format!("back-end {backend}")
    }
    fn send(&mut self, _: usize, _: &FromFrontend) -> Result<(), LinkError> {
        Ok(())
    }
    fn broadcast(&mut self, _: &FromFrontend) -> Result<(), LinkError> {
        Ok(())
    }
    fn receive(&mut self, _: Duration) -> Result<(usize, FromBackend), LinkError> {
        Ok(self.0.pop_front().unwrap_or_else(|| {
            std::thread::sleep(Duration::from_millis(1));
            (0, FromBackend::Progress { done: 0, total: 1 })
        }))
    }
    fn set_activity(&mut self, _: &str) {}
    fn revive(&mut self, _: usize) -> Result<bool, LinkError> {
        Ok(false)
    }
    fn finish(&mut self) -> Result<(), LinkError> {
        Ok(())
    }
}

fn hello(protocol: u32) -> FromBackend {
    FromBackend::Hello(Hello { protocol, host: "a".to_owned(), process: 1 })
}

fn started(rest: Vec<(usize, FromBackend)>) -> Result<Session, SessionError> {
    let first = [(0, hello(PROTOCOL_VERSION)), (1, hello(PROTOCOL_VERSION))];
    start(Box::new(Script(first.into_iter().chain(rest).collect())), setups(2))
}

fn ready() -> Vec<(usize, FromBackend)> {
    vec![(1, FromBackend::Ready(device())), (0, FromBackend::Ready(device()))]
}

#[test]
fn one_that_talks_does_not_hide_one_that_is_stuck() {
    let error = started(ready()).unwrap().render(&frame(0), &mut |_| {}).unwrap_err();
    assert!(
        matches!(&error, SessionError::Silent { name, seconds: 1, .. } if name == "back-end 1"),
        "{error}"
    );
}

#[test]
fn answers_that_were_not_asked_for_are_refused() {
    let twice = vec![(0, FromBackend::Ready(device())), (0, FromBackend::Ready(device()))];
    let early = vec![(0, FromBackend::Done(Box::new(report(0, 0))))];
    for script in [twice, early] {
        assert!(
            matches!(started(script).map(drop), Err(SessionError::Misfit { name, .. }) if name == "back-end 0")
        );
    }
    let other_frame = ready().into_iter().chain([(1, FromBackend::Done(Box::new(report(7, 1))))]).collect();
    let error = started(other_frame).unwrap().render(&frame(0), &mut |_| {}).unwrap_err();
    assert!(matches!(error, SessionError::Misfit { .. }), "{error}");
}

#[test]
fn a_run_with_traces_is_over_when_all_of_them_are_whole() {
    let end = |answer: FromBackend| {
        let first = [(0, hello(PROTOCOL_VERSION)), (1, hello(PROTOCOL_VERSION))];
        let end = [(0, FromBackend::Finished), (1, answer)];
        let script = Script(first.into_iter().chain(ready()).chain(end).collect());
        let traced = |setup| Setup { trace: Some("a.trace".into()), ..setup };
        let setups = setups(2).into_iter().map(traced).collect();
        start(Box::new(script), setups).unwrap().part().map_err(|error| error.to_string())
    };
    assert_eq!(end(FromBackend::Finished), Ok(()));
    let full = end(FromBackend::Failed("the disk is full".to_owned()));
    assert_eq!(full, Err("back-end 1 failed while finishing: the disk is full".to_owned()));
    assert!(end(FromBackend::Ready(device())).is_err_and(|error| error.contains("does not fit")));
    // Without traces nobody waits for answers, which this script would not give.
    started(ready()).unwrap().part().unwrap();
}

#[test]
fn another_protocol_is_refused_at_the_hello() {
    let script = Script([(0, hello(PROTOCOL_VERSION + 1))].into());
    let error = start(Box::new(script), setups(2)).map(drop).unwrap_err();
    assert!(error.to_string().contains("from the same build"), "{error}");
}
