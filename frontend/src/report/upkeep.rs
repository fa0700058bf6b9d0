//! What live frames did to the working set.

use super::html::table;
use super::{FrameSummary, units};
use protocol::{FrameReport, Upkeep};

/// The back-ends of one frame together: counts add up, the largest deficit is that of all, and the mean is over the rays
/// of all. None if no back-end drew a live frame.
pub(super) fn together<'a>(reports: impl IntoIterator<Item = &'a FrameReport>) -> Option<Upkeep> {
    let mut sum: Option<Upkeep> = None;
    let (mut rays, mut levels) = (0.0, 0.0);
    for (one, cast) in reports.into_iter().filter_map(|r| Some((r.upkeep?, r.rays as f64))) {
        rays += cast;
        levels += cast * one.mean_deficit;
        let before = sum.unwrap_or_default();
        sum = Some(Upkeep {
            nodes: before.nodes + one.nodes,
            leaves: before.leaves + one.leaves,
            splits: before.splits + one.splits,
            collapses: before.collapses + one.collapses,
            in_flight: before.in_flight + one.in_flight,
            cancelled: before.cancelled + one.cancelled,
            fading: before.fading + one.fading,
            largest_deficit: before.largest_deficit.max(one.largest_deficit),
            mean_deficit: if rays > 0.0 { levels / rays } else { 0.0 },
            update_ms: before.update_ms + one.update_ms,
        });
    }
    sum
}

/// A row for each live frame; nothing if there is none.
pub(super) fn section(frames: &[FrameSummary]) -> String {
    let rows: Vec<Vec<String>> =
        frames.iter().filter_map(|frame| Some(row(frame, &frame.total.upkeep?))).collect();
    if rows.is_empty() {
        return String::new();
    }
    format!("<h2>Working set of live frames</h2>{}", table(&HEADS, &rows))
}

const HEADS: [&str; 11] = [
    "",
    "nodes",
    "leaves",
    "families in",
    "out",
    "bricks under way",
    "cancelled",
    "leaves fading",
    "largest deficit",
    "mean deficit",
    "update",
];

fn row(frame: &FrameSummary, upkeep: &Upkeep) -> Vec<String> {
    let levels = |deficit: f64| format!("{deficit:.2} levels");
    vec![
        format!("frame {} at {:.3} s", frame.index, frame.time_s),
        units::count(upkeep.nodes),
        units::count(upkeep.leaves),
        units::count(upkeep.splits),
        units::count(upkeep.collapses),
        units::count(upkeep.in_flight),
        units::count(upkeep.cancelled),
        units::count(upkeep.fading),
        levels(upkeep.largest_deficit),
        levels(upkeep.mean_deficit),
        units::milliseconds(upkeep.update_ms),
    ]
}
