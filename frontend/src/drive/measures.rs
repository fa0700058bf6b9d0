//! How well the beat is kept: intervals, skew, and the time from an input to the screens.

use crate::report::{Histogram, Quantiles};
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Duration;

/// Frames whose times are kept until all back-ends have told theirs.
const MOST_OPEN: usize = 64;

/// A frame that not all have shown yet.
#[derive(Clone, Debug, Default)]
struct OpenFrame {
    /// When it began: inputs were asked then.
    began: Duration,
    /// The back-ends that had drawn it when it was to be shown.
    in_time: Vec<usize>,
    shown: Vec<(usize, Duration)>,
}

/// What is measured of a driven display.
#[derive(Clone, Debug, Default)]
pub struct Measures {
    open: BTreeMap<u32, OpenFrame>,
    /// Back-ends that have drawn each open frame.
    drawn: BTreeMap<u32, Vec<usize>>,
    last_shown: Option<Duration>,
    handing_over: Histogram,
    pub(super) interval: Histogram,
    pub(super) skew: Histogram,
    pub(super) latency: Histogram,
    pub(super) drawing: BTreeMap<usize, Histogram>,
    away: BTreeMap<usize, Histogram>,
    /// Frames that were shown by all, or by all that were in time.
    pub(super) shown: u64,
}

/// What a report says of them, milliseconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BeatSummary {
    /// Frames that were shown.
    pub frames: u64,
    /// Handing a frame's message over to all back-ends, on this machine's clock: MPI may still be on the way.
    pub handing_over_ms: Quantiles,
    /// From a frame to the next.
    pub interval_ms: Quantiles,
    /// From the first back-end that shows a frame to the last, those that were late apart.
    pub skew_ms: Quantiles,
    /// From when inputs were asked to when the last in time shows what they did.
    pub input_to_shown_ms: Quantiles,
    /// Of each back-end.
    pub backends: Vec<BackendBeat>,
}

/// How one back-end keeps the beat.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BackendBeat {
    /// Drawing a frame, as it measures it itself.
    pub drawing_ms: Quantiles,
    /// Frames that were shown without it.
    pub late: u64,
    /// How often it was lost and started again.
    pub lost: u64,
    /// From each loss to the next frame that it showed.
    pub away_ms: Quantiles,
}

impl Measures {
    /// Inputs were asked, and a frame begins.
    pub fn began(&mut self, frame: u32, now: Duration) {
        self.open.insert(frame, OpenFrame { began: now, ..OpenFrame::default() });
        while self.open.len() > MOST_OPEN {
            self.open.pop_first();
        }
        let first = self.open.keys().next().copied().unwrap_or(frame);
        self.drawn = self.drawn.split_off(&first);
    }

    /// All back-ends were told what to draw, which took so long.
    pub fn handed_over(&mut self, took: Duration) {
        self.handing_over.add(took);
    }

    /// A back-end has drawn a frame, which took it so long.
    pub fn drawn(&mut self, backend: usize, frame: u32, took_ms: f64) {
        self.drawn.entry(frame).or_default().push(backend);
        self.drawing.entry(backend).or_default().add(Duration::from_secs_f64(took_ms.max(0.0) / 1e3));
    }

    /// A frame is to be shown by those that have drawn it.
    pub fn ordered(&mut self, frame: u32) {
        let in_time = self.drawn.remove(&frame).unwrap_or_default();
        if let Some(open) = self.open.get_mut(&frame) {
            open.in_time = in_time;
        }
        self.close(frame);
    }

    /// A back-end shows a frame.
    pub fn shown(&mut self, backend: usize, frame: u32, at: Duration) {
        if let Some(open) = self.open.get_mut(&frame) {
            open.shown.push((backend, at));
        }
        self.close(frame);
    }

    /// A back-end is gone: nothing more is heard of what it was to show.
    pub fn lost(&mut self, backend: usize) {
        let frames: Vec<u32> = self.open.keys().copied().collect();
        self.open.values_mut().for_each(|open| open.in_time.retain(|&known| known != backend));
        frames.into_iter().for_each(|frame| self.close(frame));
    }

    /// A back-end that was lost shows a frame again, after so long.
    pub fn came_back(&mut self, backend: usize, away: Duration) {
        self.away.entry(backend).or_default().add(away);
    }

    /// Counts a frame that all show that were in time.
    fn close(&mut self, frame: u32) {
        let Some(open) = self.open.get(&frame) else { return };
        let time_of =
            |backend: &usize| open.shown.iter().find(|shown| shown.0 == *backend).map(|shown| shown.1);
        let times: Option<Vec<Duration>> = open.in_time.iter().map(time_of).collect();
        let Some(times) = times.filter(|times| !times.is_empty()) else { return };
        let first = times.iter().min().copied().unwrap_or_default();
        let last = times.iter().max().copied().unwrap_or_default();
        self.skew.add(last - first);
        self.latency.add(last.saturating_sub(open.began));
        // A frame that one never said it shows is counted once that one is lost, after those that came later.
        if self.last_shown.is_none_or(|before| first > before) {
            let before = self.last_shown.replace(first);
            before.iter().for_each(|&before| self.interval.add(first - before));
        }
        self.shown += 1;
        self.open.remove(&frame);
    }

    /// What is known by now; `late` and `lost` of each back-end.
    pub fn summary(&self, late: &[u64], lost: &[u64]) -> BeatSummary {
        let of = |times: &BTreeMap<usize, Histogram>, backend: usize| {
            times.get(&backend).map(Histogram::quantiles).unwrap_or_default()
        };
        let backends = late.iter().zip(lost).enumerate();
        BeatSummary {
            frames: self.shown,
            handing_over_ms: self.handing_over.quantiles(),
            interval_ms: self.interval.quantiles(),
            skew_ms: self.skew.quantiles(),
            input_to_shown_ms: self.latency.quantiles(),
            backends: backends
                .map(|(backend, (&late, &lost))| BackendBeat {
                    drawing_ms: of(&self.drawing, backend),
                    late,
                    lost,
                    away_ms: of(&self.away, backend),
                })
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_counts_once_all_in_time_show_it() {
        let (mut measures, ms) = (Measures::default(), Duration::from_millis);
        for frame in 0..2 {
            let start = 20 * u64::from(frame);
            measures.began(frame, ms(start));
            measures.drawn(0, frame, 4.0);
            measures.drawn(1, frame, 8.0);
            measures.ordered(frame);
            measures.drawn(2, frame, 30.0);
            measures.shown(1, frame, ms(start + 16));
            measures.shown(0, frame, ms(start + 17));
            measures.shown(2, frame, ms(start + 35));
        }
        let BeatSummary { frames, interval_ms, skew_ms, input_to_shown_ms, backends, .. } =
            measures.summary(&[0, 0, 2], &[0; 3]);
        assert_eq!((frames, interval_ms.max, skew_ms.max, input_to_shown_ms.max), (2, 20.0, 1.0, 17.0));
        assert_eq!(backends.iter().map(|b| b.drawing_ms.max).collect::<Vec<_>>(), [4.0, 8.0, 30.0]);
        assert_eq!(backends[2].late, 2);
    }

    #[test]
    fn a_frame_that_waits_for_one_that_is_lost_makes_no_interval_between_others() {
        let (mut measures, ms) = (Measures::default(), Duration::from_millis);
        for frame in 0..10 {
            let start = 20 * u64::from(frame);
            measures.began(frame, ms(start));
            measures.drawn(0, frame, 4.0);
            if frame == 2 {
                measures.drawn(1, frame, 4.0);
            }
            measures.ordered(frame);
            measures.shown(0, frame, ms(start + 16));
        }
        measures.lost(1);
        measures.came_back(1, ms(250));
        let summary = measures.summary(&[0, 8], &[0, 1]);
        assert_eq!((summary.frames, summary.interval_ms.max), (10, 40.0));
        let away: Vec<f64> = summary.backends.iter().map(|backend| backend.away_ms.max).collect();
        assert_eq!(away, [0.0, 250.0]);
    }

    #[test]
    fn frames_that_nobody_hears_of_again_are_dropped() {
        let mut measures = Measures::default();
        for frame in 0..1000 {
            measures.began(frame, Duration::ZERO);
            measures.drawn(0, frame, 1.0);
        }
        assert!(measures.open.len() <= MOST_OPEN && measures.drawn.len() <= MOST_OPEN);
    }
}
