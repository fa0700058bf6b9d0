//! What the eye is shown against what it should see, instant by instant.

use super::Footage;
use renderer::output::Picture;
use serde::Serialize;

/// How far what was shown is from the truth, in linear colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Score {
    /// Root of the mean square over all pixels and instants.
    pub rms: f64,
    /// The same of how pixels change from an instant to the next, against how they should: what comes late, jumps or flickers.
    pub flicker: f64,
    /// The instant with the largest RMS.
    pub worst: usize,
}

/// Scores what is shown of a scenario while it is played.
pub struct Scorer<'a> {
    footage: &'a Footage,
    before: Option<Picture>,
    squares: f64,
    flicker: f64,
    worst: (f64, usize),
    instants: usize,
}

impl<'a> Scorer<'a> {
    /// For a scenario.
    pub fn new(footage: &'a Footage) -> Self {
        Self { footage, before: None, squares: 0.0, flicker: 0.0, worst: (-1.0, 0), instants: 0 }
    }

    /// The eye is shown a picture at an instant, each after the one before.
    pub fn see(&mut self, instant: usize, shown: &Picture) {
        let truth = self.footage.truth(instant);
        let square = mean_square(&shown.rgba, |i| truth.rgba[i]);
        self.squares += square;
        if square > self.worst.0 {
            self.worst = (square, instant);
        }
        if let (Some(shown_before), Some(before)) = (&self.before, instant.checked_sub(1)) {
            let truth_before = self.footage.truth(before);
            let should = |i: usize| shown_before.rgba[i] + truth.rgba[i] - truth_before.rgba[i];
            self.flicker += mean_square(&shown.rgba, should);
        }
        self.before = Some(shown.clone());
        self.instants += 1;
    }

    /// The score of all that was seen.
    pub fn score(&self) -> Score {
        let root = |squares: f64, count: usize| (squares / count.max(1) as f64).sqrt();
        Score {
            rms: root(self.squares, self.instants),
            flicker: root(self.flicker, self.instants.saturating_sub(1)),
            worst: self.worst.1,
        }
    }
}

/// The mean square of how far red, green and blue are from what they should be.
fn mean_square(rgba: &[f32], should: impl Fn(usize) -> f32) -> f64 {
    let channels = (0..rgba.len()).filter(|i| i % 4 != 3);
    let sum: f64 = channels.map(|i| f64::from(rgba[i] - should(i)).powi(2)).sum();
    sum / (0.75 * rgba.len() as f64).max(1.0)
}
