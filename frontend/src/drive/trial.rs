//! Which caster draws a display of few projectors faster: tried out while it is driven.
//!
//! Row planes take a share of work that does not depend on the number of views, and more or less for each view than rays
//! do, by what the volume holds. So nobody knows beforehand; but a show has many frames, and a few of them tell.

use protocol::{Caster, CasterChoice};
use std::collections::BTreeMap;
use std::time::Duration;

/// Frames of a kind that are timed; the fastest counts, because whatever else the machine does only adds.
const FRAMES: usize = 2;
/// The first one of a kind is not like those that follow: tables are made, bricks arrive.
const SKIPPED: usize = 1;
/// Row planes err more than rays do, so they must save this share of the time.
const LEAST_GAIN: f64 = 1.25;
/// What is drawn has changed so much that the answer may have.
const CHANGE: f64 = 2.0;
/// Until then a volume is still getting its detail, and its frames are less work than those that follow.
const WARM_UP: Duration = Duration::from_secs(2);
/// From a try to the next, at least: each costs some frames of the slower kind.
const LEAST_INTERVAL: Duration = Duration::from_secs(10);

/// Frames that may still be under way somewhere.
const MOST_OPEN: usize = 16;

/// What is going on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Rays are timed.
    Rays,
    /// Row planes are, against these milliseconds by rays.
    Planes { rays_ms: f64 },
    /// It is decided, when frames took so many milliseconds; and since when.
    Settled { has_planes: bool, ms: f64, since: Duration },
}

/// The trial of a show.
#[derive(Clone, Debug)]
pub struct Trial {
    /// A frame that takes no longer is fast enough, milliseconds.
    period_ms: f64,
    phase: Phase,
    /// When the first frame was drawn.
    since: Option<Duration>,
    /// Whether each open frame welcomes planes.
    asked: BTreeMap<u32, bool>,
    /// The slowest back-end's milliseconds of each frame of the phase.
    times: BTreeMap<u32, f64>,
}

impl Trial {
    /// For a display of this period. None where nothing is to be chosen.
    pub fn new(asked: CasterChoice, period: Duration) -> Option<Self> {
        (asked == CasterChoice::Auto).then(|| Self {
            period_ms: 1e3 * period.as_secs_f64(),
            phase: Phase::Rays,
            since: None,
            asked: BTreeMap::new(),
            times: BTreeMap::new(),
        })
    }

    /// Whether a frame is to welcome row planes.
    pub fn begin(&mut self, frame: u32) -> bool {
        let welcomes = matches!(self.phase, Phase::Planes { .. } | Phase::Settled { has_planes: true, .. });
        self.asked.insert(frame, welcomes);
        while self.asked.len() > MOST_OPEN {
            self.asked.pop_first();
        }
        welcomes
    }

    /// A back-end has drawn a frame in so many milliseconds.
    pub fn drawn(&mut self, frame: u32, caster: &Caster, ms: f64, now: Duration) {
        let welcomed = self.asked.get(&frame).copied();
        let has_planes = matches!(caster, Caster::Planes { .. });
        let belongs = match self.phase {
            Phase::Rays => welcomed == Some(false) && !has_planes,
            Phase::Planes { .. } => welcomed == Some(true),
            Phase::Settled { has_planes, .. } => welcomed == Some(has_planes),
        };
        let is_warm = now >= *self.since.get_or_insert(now) + WARM_UP;
        if !belongs || !is_warm {
            return;
        }
        if let (Phase::Planes { rays_ms }, false) = (self.phase, has_planes) {
            // They cannot serve this scene, or this device.
            return self.settle(false, rays_ms, now);
        }
        let slowest = self.times.entry(frame).or_insert(0.0);
        *slowest = slowest.max(ms);
        if self.times.len() > FRAMES + SKIPPED {
            self.judge(now);
        }
    }

    /// What is drawn is another thing from now on.
    pub fn restart(&mut self) {
        self.enter(Phase::Rays);
    }

    /// Enough frames are timed; the one that came last may still be drawn elsewhere.
    fn judge(&mut self, now: Duration) {
        let ms = self.times.values().copied().skip(SKIPPED).take(FRAMES).fold(f64::INFINITY, f64::min);
        match self.phase {
            Phase::Rays if ms <= self.period_ms => self.settle(false, ms, now),
            Phase::Rays => self.enter(Phase::Planes { rays_ms: ms }),
            Phase::Planes { rays_ms } if ms * LEAST_GAIN < rays_ms => self.settle(true, ms, now),
            Phase::Planes { rays_ms } => self.settle(false, rays_ms, now),
            Phase::Settled { ms: before, since, .. } => {
                let has_changed = ms > CHANGE * before || before > CHANGE * ms;
                let is_slow = ms > self.period_ms;
                match has_changed && is_slow && now > since + LEAST_INTERVAL {
                    true => self.restart(),
                    false => self.times.clear(),
                }
            }
        }
    }

    fn settle(&mut self, has_planes: bool, ms: f64, since: Duration) {
        self.enter(Phase::Settled { has_planes, ms, since });
    }

    fn enter(&mut self, phase: Phase) {
        self.phase = phase;
        self.times.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: Duration = Duration::from_millis(16);

    fn planes() -> Caster {
        Caster::Planes { views: 8, fans: 1, resampled: 0 }
    }

    /// Draws frames that take so long by rays and by planes; how many of them planes drew, and the last of all.
    fn play(
        trial: &mut Trial,
        frames: std::ops::Range<u32>,
        [rays_ms, planes_ms]: [f64; 2],
    ) -> (usize, bool) {
        let mut by_planes = Vec::new();
        for frame in frames {
            let welcomes = trial.begin(frame);
            let (caster, ms) = if welcomes { (planes(), planes_ms) } else { (Caster::Rays, rays_ms) };
            // The first frame of a volume is slow whoever draws it.
            let ms = if frame == 0 { 900.0 } else { ms };
            trial.drawn(frame, &caster, ms, Duration::from_secs(frame.into()));
            trial.drawn(frame, &caster, ms / 2.0, Duration::from_secs(frame.into()));
            by_planes.push(welcomes);
        }
        (by_planes.iter().filter(|&&planes| planes).count(), *by_planes.last().unwrap())
    }

    fn trial() -> Trial {
        Trial::new(CasterChoice::Auto, PERIOD).unwrap()
    }

    #[test]
    fn the_faster_one_draws_after_a_few_frames() {
        let (mut soft, mut hard) = (trial(), trial());
        assert_eq!(play(&mut soft, 0..40, [100.0, 20.0]), (34, true));
        let tried = FRAMES + SKIPPED + 1;
        assert_eq!(play(&mut hard, 0..40, [100.0, 400.0]), (tried, false));
        assert_eq!(play(&mut trial(), 0..40, [100.0, 90.0]), (tried, false), "too little gain");
    }

    #[test]
    fn a_display_that_is_fast_enough_stays_with_rays() {
        assert_eq!(play(&mut trial(), 0..40, [15.0, 1.0]), (0, false));
        assert!(Trial::new(CasterChoice::Rays, PERIOD).is_none());
        assert!(Trial::new(CasterChoice::Planes, PERIOD).is_none());
    }

    #[test]
    fn planes_that_cannot_serve_are_asked_for_once() {
        let mut trial = trial();
        let refusal = Caster::RaysBecause("they bend".to_owned());
        let asked = (0..40).filter(|&frame| {
            let welcomes = trial.begin(frame);
            trial.drawn(frame, &refusal, 100.0, Duration::from_secs(frame.into()));
            welcomes
        });
        assert_eq!(asked.count(), 1);
    }

    #[test]
    fn what_has_changed_is_tried_anew_but_not_all_the_time() {
        let mut trial = trial();
        play(&mut trial, 0..30, [100.0, 20.0]);
        let (tried, has_planes) = play(&mut trial, 30..80, [100.0, 300.0]);
        assert!(!has_planes && tried < 25, "{tried}");
        let (tried, _) = play(&mut trial, 80..200, [100.0, 300.0]);
        assert_eq!(tried, 0, "nothing has changed");
        trial.restart();
        assert!(play(&mut trial, 200..240, [100.0, 30.0]).1, "another look");
    }
}
