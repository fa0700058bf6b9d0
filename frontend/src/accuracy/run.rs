//! A study as it is run, and what it found.

use super::bench::{self, Bench};
use super::truth::Truth;
use super::{AccuracyError, Measured, Study, TruthSummary, Watch, around_default, product};
use protocol::DeviceInfo;

/// The part of the progress bar that is the truth's.
const TRUTH_SHARE: f64 = 0.15;

/// What a study found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The device.
    pub device: DeviceInfo,
    /// How the truth was come by.
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
