//! How live frames went, one after the other: which pixels they cast, what they lacked, and how long they took.
//!
//! No rule decides what `simulate` casts and shows: each live frame casts its pixels anew and is shown. So there is no ζ, no τ and
//! nothing that is begun again, as where frames are controlled; what there is in their place is how far from wanted detail is.

use super::html::facts;
use super::plot::{Curve, Panel, Row, Strip};
use super::{FrameSummary, Histogram, Quantiles};
use protocol::Upkeep;
use serde::Serialize;
use std::time::Duration;

/// A run of live frames, in brief.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LiveSummary {
    /// Frames, each of which is shown.
    pub frames: usize,
    /// Those in which rays see something else than in the frame before; the first is one of them.
    pub changed: usize,
    /// Those that show detail which comes or goes, or for which detail is under way.
    pub with_detail: usize,
    /// Those of which nothing was missing.
    pub complete: usize,
    /// Rays by pixels, the mean over frames.
    pub mean_share: f64,
    /// The mean over frames of how many levels too coarse rays found their detail.
    pub mean_deficit: f64,
    /// The most levels by which any was.
    pub largest_deficit: f64,
    /// What the slowest back-end took for a frame.
    pub drawing_ms: Quantiles,
    #[serde(skip)]
    strip: String,
}

/// A live frame.
struct Live<'a> {
    frame: &'a FrameSummary,
    upkeep: Upkeep,
    share: f64,
    drawing_ms: f64,
}

impl Live<'_> {
    fn has_detail(&self) -> bool {
        let Upkeep { splits, collapses, in_flight, fading, .. } = self.upkeep;
        splits + collapses + in_flight + fading > 0
    }
}

impl LiveSummary {
    /// Of the frames of a run on a display of so many pixels; None where no frame was live.
    pub(super) fn of(frames: &[FrameSummary], pixels: u64) -> Option<Self> {
        let live = |frame| live(frame, pixels);
        let live: Vec<Live<'_>> = frames.iter().filter_map(live).collect();
        let first = live.first()?;
        let count = |is_so: &dyn Fn(&Live<'_>) -> bool| live.iter().filter(|&one| is_so(one)).count();
        let mean = |of: &dyn Fn(&Live<'_>) -> f64| live.iter().map(of).sum::<f64>() / live.len() as f64;
        let mut drawing = Histogram::default();
        live.iter().for_each(|one| drawing.add(Duration::from_secs_f64(one.drawing_ms.max(0.0) / 1e3)));
        let largest = live.iter().map(|one| one.upkeep.largest_deficit);
        Some(Self {
            frames: live.len(),
            changed: count(&|one| one.frame.changes),
            with_detail: count(&|one| one.has_detail()),
            complete: count(&|one| one.frame.total.complete),
            mean_share: mean(&|one| one.share),
            mean_deficit: mean(&|one| one.upkeep.mean_deficit),
            largest_deficit: largest.fold(first.upkeep.largest_deficit, f64::max),
            drawing_ms: drawing.quantiles(),
            strip: strip(&live).svg(),
        })
    }

    /// What is told on a terminal, in one line.
    pub fn line(&self) -> String {
        let Quantiles { p50, p99, .. } = self.drawing_ms;
        format!(
            "{} live frames, {} of them changed; {:.0} % of the pixels cast, {:.2} levels too coarse (most: {:.2}), {} complete; \
             drawn in {p50:.1} ms (99 %: {p99:.1})",
            self.frames,
            self.changed,
            100.0 * self.mean_share,
            self.mean_deficit,
            self.largest_deficit,
            self.complete
        )
    }

    /// The part of the page that tells of it.
    pub(super) fn section(&self) -> String {
        let Quantiles { p50, p99, max, .. } = self.drawing_ms;
        let rows = [
            ("frames, all of them shown", self.frames.to_string()),
            ("rays saw something new in", self.changed.to_string()),
            ("detail came, went or was under way in", self.with_detail.to_string()),
            ("nothing was missing in", self.complete.to_string()),
            ("pixels cast", format!("{:.0} % on average", 100.0 * self.mean_share)),
            (
                "too coarse by",
                format!("{:.2} levels on average, {:.2} at most", self.mean_deficit, self.largest_deficit),
            ),
            (
                "the slowest back-end took",
                format!("{p50:.1} ms (median), {p99:.1} ms (99 %), {max:.1} ms (largest)"),
            ),
        ];
        format!("<h2>Live frames</h2>{}{}", facts(&rows), self.strip)
    }
}

fn live(frame: &FrameSummary, pixels: u64) -> Option<Live<'_>> {
    let drawing_ms = frame.backends.iter().map(|one| one.total_ms).fold(0.0, f64::max);
    let share = frame.total.rays as f64 / pixels.max(1) as f64;
    Some(Live { frame, upkeep: frame.total.upkeep?, share, drawing_ms })
}

/// The frames over the scene's time.
fn strip(live: &[Live<'_>]) -> Strip {
    let curve = |name, tone, of: &dyn Fn(&Live<'_>) -> f64| Curve {
        name,
        tone,
        values: live.iter().map(of).collect(),
    };
    let row = |name, tone, of: &dyn Fn(&Live<'_>) -> bool| Row {
        name,
        tone,
        is_marked: live.iter().map(of).collect(),
    };
    let panel = |name, most, curves| Panel { name, most, curves };
    Strip {
        title: "Live frames".to_owned(),
        at_s: live.iter().map(|one| one.frame.time_s).collect(),
        panels: vec![
            panel("pixels cast, %", 100.0, vec![curve("pixels", 2, &|one| 100.0 * one.share)]),
            panel(
                "levels too coarse",
                0.0,
                vec![
                    curve("on average", 0, &|one| one.upkeep.mean_deficit),
                    curve("at most", 7, &|one| one.upkeep.largest_deficit),
                ],
            ),
            panel("drawn in, ms", 0.0, vec![curve("drawn", 3, &|one| one.drawing_ms)]),
        ],
        rows: vec![
            row("new", 6, &|one| one.frame.changes),
            row("detail", 1, &|one| one.has_detail()),
            row("whole", 4, &|one| one.frame.total.complete),
        ],
    }
}
