//! The account of one frame.

use protocol::{FrameReport, FrameState, Stages, Upkeep};
use serde::Serialize;
use std::time::Duration;

/// One frame: what each back-end reports, and the sums.
#[derive(Clone, Debug, Serialize)]
pub struct FrameSummary {
    /// Frame number.
    pub index: u32,
    /// Time on the scene's clock, seconds.
    pub time_s: f64,
    /// Whether rays see something else than in the frame before; in the first they do.
    pub changes: bool,
    /// Wall-clock milliseconds from the start of the frame to the last of its files.
    pub wall_ms: f64,
    /// All back-ends together.
    pub total: Totals,
    /// Each back-end's own account.
    pub backends: Vec<FrameReport>,
    /// Files of the projectors' pictures, from the output folder.
    pub pictures: Vec<String>,
    /// Files of the eyes' views, from the output folder.
    pub eye_views: Vec<String>,
}

impl FrameSummary {
    /// The account of a frame that is done, after another one.
    pub fn new(
        frame: &FrameState,
        before: Option<&FrameState>,
        backends: Vec<FrameReport>,
        wall: Duration,
        pictures: Vec<String>,
        eye_views: Vec<String>,
    ) -> Self {
        Self {
            index: frame.index,
            time_s: frame.time_s,
            changes: before.is_none_or(|before| !before.is_seen_as(frame)),
            wall_ms: 1e3 * wall.as_secs_f64(),
            total: Totals { upkeep: together(&backends), ..Totals::of(&backends) },
            backends,
            pictures,
            eye_views,
        }
    }
}

/// Reports added up.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Totals {
    /// Rays cast.
    pub rays: u64,
    /// Samples taken.
    pub samples: u64,
    /// Bricks asked for.
    pub bricks_wanted: u64,
    /// Bricks in the caches.
    pub bricks_resident: u64,
    /// Bricks loaded.
    pub bricks_loaded: u64,
    /// Bytes of voxels loaded.
    pub bytes_loaded: u64,
    /// Distinct bricks per back-end, added up over back-ends.
    pub working_set_union: u64,
    /// Distinct bricks per view, added up over views; None where any were cast together.
    pub working_set_sum: Option<u64>,
    /// What cast the rays: each sentence once.
    pub casters: Vec<String>,
    /// Time per stage, added up over back-ends.
    pub stages: Stages,
    /// Bricks that cannot be read and were missed, added up over back-ends and frames.
    pub damaged_bricks: u64,
    /// What is wrong with them: each sentence once.
    pub damaged: Vec<String>,
    /// Whether nothing was missing anywhere.
    pub complete: bool,
    /// Why not, for each back-end that was not complete.
    pub shortfall: Vec<String>,
    /// What became of the working set in one live frame; None of complete frames, and of several: nodes do not add up over
    /// time.
    pub upkeep: Option<Upkeep>,
}

impl Totals {
    /// The sum of some reports; complete where all are.
    pub fn of<'a>(reports: impl IntoIterator<Item = &'a FrameReport>) -> Self {
        let none = Self { complete: true, working_set_sum: Some(0), ..Self::default() };
        reports.into_iter().fold(none, Self::plus)
    }

    fn plus(mut self, report: &FrameReport) -> Self {
        self.rays += report.rays;
        self.samples += report.samples;
        self.bricks_wanted += report.bricks_wanted;
        self.bricks_resident += report.bricks_resident;
        self.bricks_loaded += report.bricks_loaded;
        self.bytes_loaded += report.bytes_loaded;
        self.working_set_union += report.working_set_union;
        self.working_set_sum = self.working_set_sum.zip(report.working_set_sum).map(|(a, b)| a + b);
        self.stages = self.stages + report.stages;
        let caster = report.caster.to_string();
        if !self.casters.contains(&caster) {
            self.casters.push(caster);
        }
        self.damaged_bricks += report.damaged_bricks;
        for sentence in &report.damaged {
            if !self.damaged.contains(sentence) {
                self.damaged.push(sentence.clone());
            }
        }
        self.complete &= report.complete;
        if !report.complete {
            self.shortfall.push(format!("back-end {}: {}", report.backend, report.shortfall));
        }
        self
    }
}

/// The back-ends of one frame together: counts add up, the largest deficit is that of all, and the mean is over the rays
/// of all. None where no back-end drew a live frame.
fn together<'a>(reports: impl IntoIterator<Item = &'a FrameReport>) -> Option<Upkeep> {
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
