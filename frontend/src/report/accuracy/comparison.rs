//! Seconds against one measure of error: the front, and where the default lies.

use crate::accuracy::{BEATEN_BY, Measured, Score, beaten_by, front};
use reference::Errors;
use serde::Serialize;

/// A measure of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Root of the mean square.
    Rms,
    /// What 99.9 % of the pixels stay within.
    P999,
    /// The largest.
    Max,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Rms, Self::P999, Self::Max];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rms => "RMS",
            Self::P999 => "99.9 %",
            Self::Max => "largest",
        }
    }

    /// It, in units of 1/255.
    pub fn of_255(self, errors: &Errors) -> f64 {
        255.0
            * match self {
                Self::Rms => errors.rms,
                Self::P999 => errors.p999,
                Self::Max => errors.max,
            }
    }
}

/// What one measure of error says of all settings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The measure.
    pub measure: Measure,
    /// The settings on the Pareto front, the fastest first.
    pub front: Vec<usize>,
    /// Whether no setting is both at least 5 % faster than the default and more exact.
    pub is_default_on_front: bool,
    /// Those that are.
    pub default_beaten_by: Vec<usize>,
}

impl Comparison {
    /// Of settings of which the first is the default.
    pub fn of(measure: Measure, settings: &[Measured]) -> Self {
        let score = |one: &Measured| Score { seconds: one.seconds, error: measure.of_255(&one.errors) };
        let scores: Vec<Score> = settings.iter().map(score).collect();
        let default_beaten_by = beaten_by(&scores, 0);
        Self {
            measure,
            front: front(&scores),
            is_default_on_front: default_beaten_by.is_empty(),
            default_beaten_by,
        }
    }

    /// A sentence on the default setting; it names the fastest of those that beat it.
    pub fn verdict(&self, settings: &[Measured]) -> String {
        let name = self.measure.name();
        let seconds = |index: &&usize| settings[**index].seconds;
        let fastest = self.default_beaten_by.iter().min_by(|a, b| seconds(a).total_cmp(&seconds(b)));
        let Some(&fastest) = fastest else {
            return format!(
                "{name}: the default lies on the front: nothing is {:.0} % faster and more exact",
                100.0 * BEATEN_BY
            );
        };
        let (default, other) = (&settings[0], &settings[fastest]);
        format!(
            "{name}: {} beat the default; the fastest, {}, takes {:.0} % of the time with {:.0} % of the error",
            match self.default_beaten_by.len() {
                1 => "1 setting".to_owned(),
                count => format!("{count} settings"),
            },
            other.trial.setting,
            100.0 * other.seconds / default.seconds,
            100.0 * self.measure.of_255(&other.errors) / self.measure.of_255(&default.errors),
        )
        .replacen("1 setting beat", "1 setting beats", 1)
    }
}
