//! A display driven by back-ends in threads, which draw nothing and take as long as a test says.

use super::*;
use crate::restarts::AT_ONCE;
use crate::session_fixtures::{device, frame, report, setups};
use crate::{Limits, Opened, threads};
use protocol::{
    Advance, CodesAt, DrawError, ProjectorImage, Render, ScreenImage, ScreenPicture, Screens, StopAsked,
    SwapchainChoice,
};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicU32;

const PERIOD: Duration = Duration::from_millis(20);

/// Of the frames that a back-end could show, so many it does at least on a real clock: a busy machine may be late of its own
/// accord. On simulated time it is all of them, see the laws of the beat.
const LEAST_SHARE: f64 = 0.9;

/// What a back-end does in a frame: it takes a while, and may fail.
type Behaviour = Arc<dyn Fn(u32, u32) -> Result<Duration, String> + Send + Sync>;

struct Fake {
    backend: u32,
    frame: u32,
    behaves: Behaviour,
}

impl Render for Fake {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        self.frame = frame.index;
        Ok(())
    }

    fn advance(&mut self, _: StopAsked) -> Result<Advance, DrawError> {
        std::thread::sleep((self.behaves)(self.backend, self.frame).map_err(DrawError)?);
        let report = Some(Box::new(report(self.frame, self.backend)));
        Ok(Advance { done: 1, total: 1, lacking_bricks: 0, report })
    }

    fn present(&mut self, _: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        Ok(())
    }

    fn present_on_screens(
        &mut self,
        _: CodesAt,
        sink: &mut dyn FnMut(ScreenPicture),
    ) -> Result<(), DrawError> {
        let [a, b, c, _] = self.frame.to_le_bytes();
        sink(ScreenPicture::Host(ScreenImage {
            projector: self.backend,
            width: 1,
            height: 1,
            rgb: vec![a, b, c],
        }));
        Ok(())
    }
}

const TO_FRONTEND: Screens = Screens { frontend: true, outputs: false, swapchain: SwapchainChoice::Auto };

fn driving(backends: u32, time: Time, behaves: Behaviour) -> Drive {
    let open = move |setup: Setup| -> Result<Opened, String> {
        let fake = Fake { backend: setup.options.backend, frame: 0, behaves: Arc::clone(&behaves) };
        Ok(Opened::new(Box::new(fake), device()))
    };
    let link = Box::new(threads::spawn(backends as usize, open).unwrap());
    let setups: Vec<Setup> =
        setups(backends).into_iter().map(|setup| Setup { screens: TO_FRONTEND, ..setup }).collect();
    let session = Session::start(link, setups.clone(), Limits::default(), Arc::default()).unwrap();
    Drive::new(session, setups, PERIOD, time)
}

/// What is known of a show.
#[derive(Default)]
struct Seen {
    /// Of each back-end, the frames that it showed, with their times.
    shown: BTreeMap<usize, Vec<(u32, Duration)>>,
    ordered: BTreeMap<u32, Duration>,
    lost: Vec<String>,
    returned: usize,
    pictures: BTreeMap<usize, Vec<u32>>,
}

/// Drives so many frames.
fn play(drive: &mut Drive, frames: u32) -> Seen {
    let mut seen = Seen::default();
    loop {
        match drive.await_next().unwrap() {
            Happening::Due { frame: index, .. } if index == frames => break,
            Happening::Due { frame: index, .. } => drive.draw(&frame(index), None).unwrap(),
            other => note(&mut seen, other),
        }
    }
    while let Some(happening) = drive.settle().unwrap() {
        note(&mut seen, happening);
    }
    drive.finish().unwrap();
    seen
}

fn note(seen: &mut Seen, happening: Happening) {
    match happening {
        Happening::Shown { backend, frame, at, away } => {
            seen.returned += usize::from(away.is_some());
            seen.shown.entry(backend).or_default().push((frame, at));
        }
        Happening::Ordered { frame, at } => drop(seen.ordered.insert(frame, at)),
        Happening::Lost { why, .. } => seen.lost.push(why),
        Happening::Screen { backend, image } => {
            let number = u32::from_le_bytes([image.rgb[0], image.rgb[1], image.rgb[2], 0]);
            seen.pictures.entry(backend).or_default().push(number);
        }
        Happening::Drawn { .. }
        | Happening::Said { .. }
        | Happening::Standstill { .. }
        | Happening::Due { .. }
        | Happening::Finished { .. }
        | Happening::Stopped => {}
    }
}

/// A time that looks random, and is the same each time.
fn some(backend: u32, frame: u32, most_us: u64) -> Duration {
    let mixed = (u64::from(backend) << 32 | u64::from(frame)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    Duration::from_micros((mixed >> 40) % most_us)
}

#[test]
fn on_a_clock_that_steps_every_back_end_shows_every_frame_in_order() {
    for backends in [1, 2, 4] {
        let mut drive = driving(backends, Time::stepped(), Arc::new(|b, f| Ok(some(b, f, 3_000))));
        let seen = play(&mut drive, 40);
        assert_eq!(seen.shown.len(), backends as usize);
        for (backend, shown) in &seen.shown {
            let frames: Vec<u32> = shown.iter().map(|shown| shown.0).collect();
            assert_eq!(frames, (0..40).collect::<Vec<_>>());
            assert_eq!(seen.pictures[backend], frames);
        }
        assert_eq!(drive.late(), vec![0; backends as usize]);
        let steps: Vec<Duration> = seen.ordered.values().copied().collect();
        assert!(steps.windows(2).all(|pair| pair[1] - pair[0] == PERIOD), "{steps:?}");
    }
}

#[test]
fn on_a_real_clock_none_shows_a_frame_before_its_time() {
    let mut drive = driving(3, Time::Real, Arc::new(|b, f| Ok(some(b, f, 4_000))));
    let seen = play(&mut drive, 60);
    for (frame, at) in seen.shown.values().flatten() {
        // What one process thinks of another's clock errs by half a message's way; here they share one.
        assert!(*at + Duration::from_millis(2) >= seen.ordered[frame], "{frame}");
    }
    assert!(seen.shown.values().all(|shown| shown.windows(2).all(|pair| pair[0].0 < pair[1].0)));
}

#[test]
fn one_that_hangs_is_late_and_the_others_go_on() {
    let hangs = |backend, frame| match (backend, frame) {
        (1, 10) => Ok(Duration::from_millis(400)),
        _ => Ok(Duration::from_millis(1)),
    };
    let mut drive = driving(3, Time::Real, Arc::new(hangs));
    let seen = play(&mut drive, 80);
    let late = drive.late();
    assert!(late[1] >= 10, "{late:?}");
    for backend in [0, 2] {
        let shown = seen.shown[&backend].len();
        assert!(shown as f64 >= LEAST_SHARE * 80.0, "{backend} shows {shown}");
    }
    let frames: Vec<u32> = seen.shown[&1].iter().map(|shown| shown.0).collect();
    assert!(frames.contains(&10) && frames.last() == Some(&79), "{frames:?}");
    assert!(seen.lost.is_empty());
}

#[test]
fn those_that_fail_or_panic_come_back_while_the_others_go_on() {
    let failures = Arc::new(AtomicU32::new(0));
    let counted = Arc::clone(&failures);
    let failed = AtomicU32::new(0);
    let fails = move |backend, frame| {
        // Each frame fails once: who comes back may be asked for it again.
        let is_due = backend == 1 && frame % 8 == 5 && counted.load(Ordering::SeqCst) < AT_ONCE;
        if is_due && failed.swap(frame, Ordering::SeqCst) != frame {
            match counted.fetch_add(1, Ordering::SeqCst) % 2 {
                0 => return Err("the volume went away".to_owned()),
                _ => panic!("a fault"),
            }
        }
        Ok(Duration::from_millis(1))
    };
    let mut drive = driving(3, Time::Real, Arc::new(fails));
    let seen = play(&mut drive, 200);
    let lost = failures.load(Ordering::SeqCst) as usize;
    assert_eq!([lost, seen.lost.len()], [AT_ONCE as usize; 2]);
    assert!(seen.returned + 1 >= lost, "{} of {lost}", seen.returned);
    assert!(seen.lost.iter().any(|why| why.contains("the volume went away")));
    assert!(seen.lost.iter().any(|why| why.contains("a fault")));
    for backend in [0, 2] {
        let shown = seen.shown[&backend].len();
        assert!(shown as f64 >= LEAST_SHARE * 200.0, "{backend} shows {shown}");
    }
    assert!(seen.shown[&1].len() > 50);
}

#[test]
fn one_that_fails_again_and_again_is_started_ever_more_seldom() {
    let fails = |backend, frame| match (backend, frame) {
        (1, 5..) => Err("the server is gone".to_owned()),
        _ => Ok(Duration::from_millis(1)),
    };
    let mut drive = driving(2, Time::Real, Arc::new(fails));
    let seen = play(&mut drive, 200);
    let lost = seen.lost.len();
    // After those at once and one more come waits of 1, 2, 4 and 8 s, longer than all of this takes.
    assert!((AT_ONCE as usize..AT_ONCE as usize + 5).contains(&lost), "{lost}");
    let shown = seen.shown[&0].len();
    assert!(shown as f64 >= LEAST_SHARE * 200.0, "{shown}");
    let since = Instant::now();
    drive.finish().unwrap();
    assert!(since.elapsed() < Duration::from_secs(1), "nobody waits for one that waits");
}

#[test]
fn a_frame_that_ends_the_only_back_end_each_time_is_left_out() {
    let fails = |_, frame| match frame {
        3 => Err("it is too much".to_owned()),
        _ => Ok(Duration::from_millis(1)),
    };
    for time in [Time::Real, Time::stepped()] {
        let mut drive = driving(1, time, Arc::new(fails));
        let seen = play(&mut drive, 8);
        assert_eq!(seen.lost.len(), 2, "it may try twice");
        let frames: Vec<u32> = seen.shown[&0].iter().map(|shown| shown.0).collect();
        // On a busy machine the back-end may end before it has shown the frame before: that goes with it.
        let shows_all = time.is_stepped() || frames.contains(&2);
        let expected = [0, 1, 2, 4, 5, 6, 7].into_iter().filter(|&frame| shows_all || frame != 2);
        assert_eq!(frames, expected.collect::<Vec<_>>());
    }
}

#[test]
fn a_controlled_display_shows_what_somebody_decides() {
    for time in [Time::stepped(), Time::Real] {
        let mut drive = driving(3, time, Arc::new(|b, f| Ok(some(b, f, 3_000)))).controlled();
        let (mut seen, mut passed) = (Seen::default(), 0);
        loop {
            match drive.await_next().unwrap() {
                Happening::Due { frame: 30, .. } => break,
                // Now and then there is nothing to do.
                Happening::Due { frame: index, .. } if index % 10 == 4 && passed <= index / 10 => {
                    passed += 1;
                    drive.pass();
                }
                Happening::Due { frame: index, .. } => drive.draw(&frame(index), None).unwrap(),
                Happening::Finished { frame } => {
                    drive.decide(frame % 3 == 0).unwrap().into_iter().for_each(|one| note(&mut seen, one));
                }
                other => note(&mut seen, other),
            }
        }
        while let Some(happening) = drive.settle().unwrap() {
            note(&mut seen, happening);
        }
        drive.finish().unwrap();
        assert_eq!(passed, 3);
        let decided: Vec<u32> = (0..30).step_by(3).collect();
        for shown in seen.shown.values() {
            let frames: Vec<u32> = shown.iter().map(|shown| shown.0).collect();
            match time {
                Time::Stepped(_) => assert_eq!(frames, decided),
                // One that is late on a busy machine leaves some out.
                Time::Real => {
                    assert!(frames.iter().all(|frame| decided.contains(frame)) && !frames.is_empty())
                }
            }
        }
    }
}

#[test]
fn one_that_fails_in_its_first_frame_ends_the_show() {
    let mut drive = driving(2, Time::Real, Arc::new(|_, _| Err("it cannot be drawn".to_owned())));
    let error = loop {
        match drive.await_next() {
            Ok(Happening::Due { frame: index, .. }) => drive.draw(&frame(index), None).unwrap(),
            Ok(other) => assert!(!matches!(other, Happening::Lost { .. })),
            Err(error) => break error.to_string(),
        }
    };
    assert!(error.contains("failed while driving the display: it cannot be drawn"), "{error}");
}
