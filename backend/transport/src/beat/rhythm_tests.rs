//! Laws of the beat, with back-ends that take as long as a test says: time is simulated, and nothing waits.

use super::super::stage::Stage;
use super::*;
use proptest::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

const PERIOD: Duration = Duration::from_millis(16);
const LEAD: Duration = Duration::from_millis(2);
const RHYTHM: Rhythm = Rhythm { period: PERIOD, lead: LEAD, breath: Duration::from_millis(1) };

/// What happens at some time to some back-end; or to the front-end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    Asked(u32),
    HasDrawn(u32),
    Ordered(u32, Duration),
    Shows,
    TellsDrawn(u32),
    Wakes,
}

/// A back-end that takes time, and never does two things at once.
#[derive(Default)]
struct Model {
    drawing: Option<u32>,
    waiting: Option<u32>,
    stage: Stage,
    /// When it showed which frame.
    shown: Vec<(Duration, u32)>,
}

/// A show of so many frames, and what each back-end showed when.
struct Show {
    beat: Beat,
    models: Vec<Model>,
    events: BinaryHeap<Reverse<(Duration, usize, Event)>>,
    ordered: Vec<(Duration, u32)>,
    /// Frames that are drawn and not shown.
    keeps_back: fn(u32) -> bool,
    /// When the latest message reaches each back-end: none overtakes another.
    reached: Vec<Duration>,
}

impl Show {
    /// `takes` says how long a back-end draws a frame, and `travels` how long a message takes.
    fn run(
        backends: usize,
        frames: u32,
        takes: &mut dyn FnMut(usize, u32) -> Duration,
        travels: &mut dyn FnMut() -> Duration,
    ) -> Self {
        Self::controlled(backends, frames, |_| false, takes, travels)
    }

    /// The same, but some frames are not shown.
    fn controlled(
        backends: usize,
        frames: u32,
        keeps_back: fn(u32) -> bool,
        takes: &mut dyn FnMut(usize, u32) -> Duration,
        travels: &mut dyn FnMut() -> Duration,
    ) -> Self {
        let mut show = Self {
            keeps_back,
            reached: vec![Duration::ZERO; backends],
            beat: Beat::new(RHYTHM, backends, Duration::ZERO),
            models: (0..backends).map(|_| Model::default()).collect(),
            events: BinaryHeap::new(),
            ordered: Vec::new(),
        };
        show.lead(Duration::ZERO, frames, travels);
        while let Some(Reverse((now, backend, event))) = show.events.pop() {
            match event {
                Event::TellsDrawn(frame) => show.beat.drawn(backend, frame, now),
                Event::Wakes => {}
                event => show.happens(now, backend, event, takes, travels),
            }
            show.lead(now, frames, travels);
        }
        show
    }

    /// What the front-end does at a time.
    fn lead(&mut self, now: Duration, frames: u32, travels: &mut dyn FnMut() -> Duration) {
        loop {
            match self.beat.step(now) {
                Step::Begin { frame, .. } if frame == frames => return,
                Step::Begin { frame, .. } => {
                    self.beat.begin(now);
                    self.tell_all(now, Event::Asked(frame), travels);
                }
                Step::Show { frame, .. } if (self.keeps_back)(frame) => self.beat.keep_back(now),
                Step::Show { frame, at } => {
                    self.ordered.push((at, frame));
                    self.tell_all(now, Event::Ordered(frame, at), travels);
                }
                Step::Wait { until } => {
                    self.events.extend(until.map(|until| Reverse((until, 0, Event::Wakes))));
                    return;
                }
            }
        }
    }

    /// A message to every back-end.
    fn tell_all(&mut self, now: Duration, event: Event, travels: &mut dyn FnMut() -> Duration) {
        for backend in 0..self.models.len() {
            let at = (now + travels()).max(self.reached[backend] + Duration::from_nanos(1));
            self.reached[backend] = at;
            self.events.push(Reverse((at, backend, event)));
        }
    }

    fn happens(
        &mut self,
        now: Duration,
        backend: usize,
        event: Event,
        takes: &mut dyn FnMut(usize, u32) -> Duration,
        travels: &mut dyn FnMut() -> Duration,
    ) {
        let model = &mut self.models[backend];
        match event {
            Event::Asked(frame) => {
                model.stage.asked();
                model.waiting = Some(frame);
            }
            Event::HasDrawn(frame) => {
                model.drawing = None;
                model.stage.drawn(frame);
                self.events.push(Reverse((now + travels(), backend, Event::TellsDrawn(frame))));
            }
            Event::Ordered(frame, at) => model.stage.order(frame, at.as_micros() as u64),
            Event::Shows | Event::TellsDrawn(_) | Event::Wakes => {}
        }
        if model.drawing.is_none()
            && let Some(frame) = model.waiting.take()
        {
            model.drawing = Some(frame);
            self.events.push(Reverse((now + takes(backend, frame), backend, Event::HasDrawn(frame))));
        }
        if let Some((frame, when)) = model.stage.due(now.as_micros() as u64) {
            let when = Duration::from_micros(when);
            if when <= now {
                model.stage.shown(frame);
                model.shown.push((now, frame));
            } else {
                self.events.push(Reverse((when, backend, Event::Shows)));
            }
        }
    }

    /// Moments at which not all back-ends show the same.
    fn tears(&self) -> usize {
        let mut moments: Vec<Duration> =
            self.models.iter().flat_map(|model| model.shown.iter().map(|shown| shown.0)).collect();
        moments.sort();
        moments.dedup();
        let shows = |model: &Model, at: Duration| {
            let after = model.shown.partition_point(|shown| shown.0 <= at);
            after.checked_sub(1).map(|i| model.shown[i].1)
        };
        let is_torn =
            |&&at: &&Duration| self.models.iter().any(|model| shows(model, at) != shows(&self.models[0], at));
        moments.iter().filter(is_torn).count()
    }
}

/// A generator of its own, so that a test is the same everywhere.
struct Dice(u64);

impl Dice {
    fn throw(&mut self, low_us: u64, high_us: u64) -> Duration {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Duration::from_micros(low_us + (self.0 >> 33) % (high_us - low_us))
    }
}

#[test]
fn nothing_tears_while_all_keep_the_deadline() {
    const FRAMES: u32 = 10_000;
    for backends in [1, 2, 4, 36] {
        let (mut draws, mut messages) = (Dice(7), Dice(8));
        // Every frame is drawn within the period that the shortest deadline leaves, and every message within the lead.
        let show = Show::run(backends, FRAMES, &mut |_, _| draws.throw(500, 9_500), &mut || {
            messages.throw(10, 1_500)
        });
        assert_eq!(show.tears(), 0, "{backends}");
        assert_eq!(show.beat.late().iter().sum::<u64>(), 0);
        for model in &show.models {
            let frames: Vec<u32> = model.shown.iter().map(|shown| shown.1).collect();
            assert_eq!(frames, (0..FRAMES).collect::<Vec<_>>());
            let is_steady = |pair: &[(Duration, u32)]| pair[1].0 - pair[0].0 == PERIOD;
            assert!(model.shown[2..].windows(2).all(is_steady), "{backends}");
        }
    }
}

#[test]
fn nothing_tears_where_frames_are_kept_back() {
    const FRAMES: u32 = 10_000;
    for backends in [1, 4, 36] {
        let (mut draws, mut messages) = (Dice(17), Dice(18));
        let keeps_back = |frame: u32| !frame.is_multiple_of(7) && frame % 5 != 2;
        let show =
            Show::controlled(backends, FRAMES, keeps_back, &mut |_, _| draws.throw(500, 9_500), &mut || {
                messages.throw(10, 1_500)
            });
        assert_eq!((show.tears(), show.beat.late().iter().sum::<u64>()), (0, 0), "{backends}");
        for model in &show.models {
            let frames: Vec<u32> = model.shown.iter().map(|shown| shown.1).collect();
            assert_eq!(frames, (0..FRAMES).filter(|&frame| !keeps_back(frame)).collect::<Vec<_>>());
        }
        // What is kept back costs no period.
        let length = show.models[0].shown.last().map(|shown| shown.0).unwrap_or_default();
        assert!(length < PERIOD * FRAMES * 4 / 5, "{length:?}");
    }
}

#[test]
fn a_beat_with_nothing_to_draw_waits_a_period() {
    let mut beat = Beat::new(RHYTHM, 1, Duration::ZERO);
    let ms = Duration::from_millis;
    assert!(matches!(beat.step(ms(0)), Step::Begin { frame: 0, .. }));
    beat.pass(ms(0));
    assert_eq!(beat.step(ms(1)), Step::Wait { until: Some(PERIOD) });
    assert!(matches!(beat.step(PERIOD), Step::Begin { frame: 0, .. }), "its number is not used up");
}

/// The canary: messages that take longer than the lead do tear, and that is seen.
#[test]
fn messages_beyond_the_lead_tear_and_are_seen_to() {
    let (mut draws, mut messages) = (Dice(7), Dice(8));
    let show = Show::run(4, 1000, &mut |_, _| draws.throw(500, 9_000), &mut || messages.throw(10, 9_000));
    assert!(show.tears() > 0);
}

#[test]
fn frames_that_take_longer_than_a_period_come_as_often_as_they_can() {
    let (mut draws, mut messages) = (Dice(1), Dice(2));
    let show = Show::run(3, 2000, &mut |_, _| draws.throw(40_000, 60_000), &mut || messages.throw(10, 500));
    assert_eq!((show.tears(), show.beat.late()), (0, vec![0; 3]));
    let shown = &show.models[0].shown;
    let mean_s = (shown[1999].0 - shown[9].0).as_secs_f64() / 1990.0;
    // The slowest of three takes 55 ms; what is drawn is shown in the next slot, while the next frame is drawn.
    assert!((0.050..0.060).contains(&mean_s), "{mean_s}");
}

#[test]
fn one_that_is_slow_holds_up_one_frame_and_then_shows_its_own() {
    for late in 0..4 {
        let mut messages = Dice(3);
        let is_slow = |frame: u32| (100..140).contains(&frame);
        let mut takes = |backend: usize, frame: u32| match backend == late && is_slow(frame) {
            true => Duration::from_millis(50),
            false => Duration::from_millis(9),
        };
        let show = Show::run(4, 400, &mut takes, &mut || messages.throw(10, 1_000));
        for (backend, model) in show.models.iter().enumerate() {
            let gaps = model.shown[2..].windows(2).map(|pair| (pair[1].0 - pair[0].0).as_micros());
            let held_up = gaps.clone().filter(|&gap| gap > PERIOD.as_micros()).count();
            if backend == late {
                assert!(held_up > 5, "it is slow, and yet shows every frame");
            } else {
                assert!(held_up <= 1, "{late} holds {backend} up {held_up} times");
                assert!(gaps.max() <= Some(2 * PERIOD.as_micros()), "{late} {backend}");
                assert_eq!(model.shown.len(), 400, "others show every frame");
            }
            // Its frames come in order, and it ends with the others.
            assert!(model.shown.windows(2).all(|pair| pair[0].1 < pair[1].1));
            assert_eq!(model.shown.last().map(|shown| shown.1), Some(399));
        }
        let counted = show.beat.late();
        assert!(counted[late] > 20 && counted.iter().sum::<u64>() == counted[late], "{counted:?}");
        let on_its_own: Vec<u32> = show.models[late].shown.iter().map(|shown| shown.1).collect();
        // From the first slow frame until it has caught up, and not outside.
        assert_eq!(on_its_own[..100], (0..100).collect::<Vec<_>>()[..]);
        assert_eq!(on_its_own[on_its_own.len() - 240..], (160..400).collect::<Vec<_>>()[..]);
    }
}

#[test]
fn one_that_is_lost_is_not_waited_for_and_comes_back() {
    let mut beat = Beat::new(RHYTHM, 2, Duration::ZERO);
    let ms = Duration::from_millis;
    assert!(matches!(beat.step(ms(0)), Step::Begin { frame: 0, .. }));
    beat.begin(ms(0));
    beat.drawn(0, 0, ms(5));
    assert_eq!(beat.step(ms(5)), Step::Wait { until: None }, "nobody knows yet how long frames take");
    beat.lost(1);
    assert!(matches!(beat.step(ms(6)), Step::Show { frame: 0, .. }));
    assert!(matches!(beat.step(ms(17)), Step::Begin { frame: 1, .. }));
    beat.begin(ms(17));
    beat.returned(1);
    assert_eq!(beat.owing().collect::<Vec<_>>(), [0], "it takes part from the next frame on");
    beat.drawn(0, 1, ms(20));
    assert!(matches!(beat.step(ms(20)), Step::Show { frame: 1, .. }));
    beat.begin(ms(33));
    assert_eq!(beat.owing().collect::<Vec<_>>(), [0, 1]);
    assert_eq!(beat.late(), [0, 1], "it has missed one");
}

#[test]
fn a_frame_that_ends_all_who_draw_it_is_given_up() {
    let (mut beat, ms) = (Beat::new(RHYTHM, 1, Duration::ZERO), Duration::from_millis);
    beat.begin(ms(0));
    beat.lost(0);
    assert_eq!(beat.step(ms(5)), Step::Wait { until: None });
    beat.returned(0);
    beat.asked(0, 0, ms(50));
    assert_eq!(beat.step(ms(51)), Step::Wait { until: None }, "it tries again");
    beat.lost(0);
    beat.returned(0);
    assert_eq!(beat.step(ms(90)), Step::Wait { until: Some(ms(90)) });
    assert!(matches!(beat.step(ms(90)), Step::Begin { frame: 1, .. }));
    beat.begin(ms(90));
    beat.drawn(0, 1, ms(95));
    assert!(matches!(beat.step(ms(95)), Step::Show { frame: 1, .. }));
}

#[test]
fn nobody_waits_for_one_that_comes_back_and_takes_long_to_draw_its_first_frame() {
    let (mut beat, ms) = (Beat::new(RHYTHM, 2, Duration::ZERO), Duration::from_millis);
    beat.begin(ms(0));
    beat.drawn(0, 0, ms(5));
    beat.drawn(1, 0, ms(5));
    assert!(matches!(beat.step(ms(5)), Step::Show { frame: 0, .. }));
    beat.lost(1);
    beat.returned(1);
    beat.begin(ms(17));
    beat.drawn(0, 1, ms(22));
    assert!(matches!(beat.step(ms(22)), Step::Show { frame: 1, .. }));
    beat.begin(ms(34));
    beat.drawn(1, 1, ms(36));
    beat.drawn(1, 2, ms(40));
    beat.drawn(0, 2, ms(40));
    assert!(matches!(beat.step(ms(40)), Step::Show { frame: 2, .. }));
    beat.begin(ms(51));
    beat.drawn(0, 3, ms(55));
    assert!(matches!(beat.step(ms(56)), Step::Wait { .. }), "it is one of them again");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// However long anything takes: every back-end shows rising frames, every frame is ordered once and in order, and all
    /// end with the same.
    #[test]
    fn the_show_goes_on_whatever_takes_long(seed in any::<u64>(), backends in 1_usize..6, longest_ms in 1_u64..300) {
        let (mut draws, mut messages) = (Dice(seed), Dice(!seed));
        let mut takes = |_: usize, frame: u32| match frame % 7 {
            0 => draws.throw(100, 1000 * longest_ms + 101),
            _ => draws.throw(100, 12_000),
        };
        let show = Show::run(backends, 200, &mut takes, &mut || messages.throw(10, 1_900));
        let ordered: Vec<u32> = show.ordered.iter().map(|order| order.1).collect();
        prop_assert_eq!(ordered, (0..200).collect::<Vec<_>>());
        prop_assert!(show.ordered.windows(2).all(|pair| pair[0].0 < pair[1].0));
        for model in &show.models {
            prop_assert!(model.shown.windows(2).all(|pair| pair[0].1 < pair[1].1));
            prop_assert_eq!(model.shown.last().map(|shown| shown.1), Some(199));
            for (at, frame) in &model.shown {
                prop_assert!(at >= &show.ordered[*frame as usize].0, "shown before its time");
            }
        }
    }
}
