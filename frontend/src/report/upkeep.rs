//! What live frames did to the working set.

use super::html::table;
use super::{FrameSummary, units};
use protocol::Upkeep;

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
