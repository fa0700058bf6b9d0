//! A study: from a scene to what its settings cost and miss.

use super::bench::{self, Bench};
use super::truth::Truth;
use super::{AccuracyError, Measured, TruthSummary, Watch, around_default, product};
use bricks::BrickSource;
use display_config::Display;
use protocol::{DeviceChoice, DeviceInfo, FrameState};
use std::sync::Arc;

/// The part of the progress bar that is the truth's.
const TRUTH_SHARE: f64 = 0.15;

/// What is measured.
pub struct Study {
    /// The display.
    pub display: Display,
    /// The frame; its own quality is tried, too.
    pub frame: FrameState,
    /// The volume.
    pub source: Arc<dyn BrickSource>,
    /// The projectors whose pictures are compared and timed; at least one.
    pub projectors: Vec<u32>,
    /// Every how many pixels along x and y are compared; None for as many as half a minute of truth allows.
    pub stride: Option<u32>,
    /// How often each setting is timed: an odd number.
    pub repetitions: u32,
    /// Whether every combination is tried.
    pub is_full: bool,
    /// Whether the default setting, and those around it, are taken at the finest level.
    pub is_finest: bool,
    /// The device.
    pub device: DeviceChoice,
    /// Its brick cache, bytes.
    pub cache_bytes: u64,
}

/// What a study found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The device.
    pub device: DeviceInfo,
    /// How the truth was computed.
    pub truth: TruthSummary,
    /// All settings; the default comes first.
    pub measured: Vec<Measured>,
}

impl Study {
    /// Takes the truth, and measures every setting against it. It writes nothing.
    ///
    /// # Errors
    /// A device, a brick or the reference fails, nothing is visible, or `watch` says stop.
    pub fn run(&self, watch: &Watch) -> Result<Outcome, AccuracyError> {
        watch.tell(0.0, "the device");
        let (offer, device) = bench::offer(self)?;
        let trials = if self.is_full { product(&offer) } else { around_default(&offer, &self.frame.quality) };
        let truth = Truth::of(self, watch, &|part| watch.tell(TRUTH_SHARE * part, "the truth"))?;
        let show = |done: usize| {
            let part = TRUTH_SHARE + (1.0 - TRUTH_SHARE) * done as f64 / trials.len() as f64;
            watch.tell(part, &format!("setting {done} of {}", trials.len()));
        };
        let measured = Bench::new(self, &truth).measure(&trials, watch, &show)?;
        Ok(Outcome { device, truth: truth.summary, measured })
    }
}
