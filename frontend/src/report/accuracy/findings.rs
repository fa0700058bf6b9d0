//! What a study of accuracy found.

use super::{Comparison, Measure};
use crate::accuracy::{Measured, Outcome, Study, TruthSummary};
use crate::report::run::command_line;
use crate::report::{DisplaySummary, SceneSummary};
use crate::scene::{Scene, VolumeFacts};
use protocol::DeviceInfo;
use serde::Serialize;
use std::time::Duration;

/// What the seconds are.
const TIMING: &str = "the cast alone: every ray of the chosen projectors, and the look ahead by one ray in 256, with all \
    bricks resident; on a GPU with what rays tell of bricks brought back. The median of the repetitions after one frame \
    that brings the bricks. Loading, uploading and reading pictures back are not in it";

/// All of it.
#[derive(Clone, Debug, Serialize)]
pub struct AccuracyReport {
    /// Version of the program.
    pub version: &'static str,
    /// How it was called.
    pub command_line: Vec<String>,
    /// The scene.
    pub scene: SceneSummary,
    /// The display.
    pub display: DisplaySummary,
    /// What drew.
    pub device: DeviceInfo,
    /// The frame.
    pub frame: u32,
    /// The projectors whose pictures were compared and timed.
    pub projectors: Vec<u32>,
    /// How the truth was come by.
    pub truth: TruthSummary,
    /// How often each setting was timed.
    pub repetitions: u32,
    /// What the seconds are.
    pub timing: &'static str,
    /// Which settings no other one beats, by each measure of error.
    pub comparisons: Vec<Comparison>,
    /// All settings; the default comes first.
    pub settings: Vec<Measured>,
    /// Wall-clock milliseconds of the whole.
    pub wall_ms: f64,
}

impl AccuracyReport {
    /// The report of a study that is done.
    pub fn new(scene: &Scene, facts: &VolumeFacts, study: &Study, outcome: Outcome, wall: Duration) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            command_line: command_line(),
            scene: SceneSummary::new(scene, facts, &study.frame),
            display: DisplaySummary::new(&study.display, &study.frame),
            device: outcome.device,
            frame: study.frame.index,
            projectors: study.projectors.clone(),
            truth: outcome.truth,
            repetitions: study.repetitions,
            timing: TIMING,
            comparisons: Measure::ALL.iter().map(|&m| Comparison::of(m, &outcome.measured)).collect(),
            settings: outcome.measured,
            wall_ms: 1e3 * wall.as_secs_f64(),
        }
    }

    /// What a person must not overlook.
    pub fn notes(&self) -> Vec<String> {
        let truth = &self.truth;
        let mut notes = Vec::new();
        if truth.not_reached > 0 {
            notes.push(format!(
                "the reference did not reach its tolerance of {:.0e} at {} of {} rays; there it may be off by {:.1e} \
                 of 255",
                truth.tolerance,
                truth.not_reached,
                truth.rays,
                255.0 * truth.largest_estimate
            ));
        }
        let least = self.settings.iter().map(|one| one.errors.rms).fold(f64::INFINITY, f64::min);
        if least < 100.0 * truth.tolerance {
            let times = least / truth.tolerance;
            notes.push(format!(
                "the most exact setting errs by only {times:.0} times the reference's tolerance"
            ));
        }
        if truth.rays < 1000 {
            notes.push(format!(
                "{} rays are too few for the 99.9 %, which is the largest error then",
                truth.rays
            ));
        }
        let short = self.settings.iter().filter(|one| !one.shortfall.is_empty());
        if let (count @ 1.., Some(first)) = (short.clone().count(), short.clone().next()) {
            notes.push(format!("pictures of {count} settings are not complete: {}", first.shortfall));
        }
        notes
    }

    /// A sentence on the default setting for each measure of error.
    pub fn verdicts(&self) -> Vec<String> {
        self.comparisons.iter().map(|comparison| comparison.verdict(&self.settings)).collect()
    }
}
