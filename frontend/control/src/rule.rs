//! What decides when a picture is given up for a newer one, and when it is shown.

use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::str::FromStr;
use std::time::Duration;

/// How errors in space and in time are weighed against each other; each number from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Weights {
    /// ρ: how soon a picture is given up for a newer one. 0 is when it is complete, 1 at once.
    pub rho: f64,
    /// ϑ: how soon a picture of the newest state replaces a finer one of an older state. 0 is when it is the finer one, 1
    /// at once.
    pub theta: f64,
    /// χ: the error in space at which refining pauses, for a second at most; 0 is never.
    pub chi: f64,
}

impl Default for Weights {
    /// The best of a sweep over recorded motions: `lightloom tune`.
    fn default() -> Self {
        Self { rho: 0.5, theta: 0.5, chi: 0.0 }
    }
}

/// What decides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// Errors.
    Errors(Weights),
    /// Time: a picture of a state that has changed is shown, and given up, after so long.
    Rate {
        /// So long.
        period: Duration,
    },
    /// Rays: it is shown, and given up, when such a share of them is cast.
    Quality {
        /// From 0 to 1.
        share: f64,
    },
}

impl Default for Rule {
    fn default() -> Self {
        Self::Errors(Weights::default())
    }
}

/// Why a text is no rule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{text:?} is no way to control frames; give errors, rate=HZ (0.1 to 1000), or quality=SHARE (above 0, up to 1)"
)]
pub struct RuleError {
    text: String,
}

impl FromStr for Rule {
    type Err = RuleError;

    fn from_str(text: &str) -> Result<Self, RuleError> {
        let wrong = || RuleError { text: text.chars().take(40).collect() };
        let number = |text: &str| text.parse::<f64>().map_err(|_| wrong());
        match text.split_once('=') {
            None if text == "errors" => Ok(Self::default()),
            Some(("rate", hz)) => match number(hz)? {
                hz if (0.1..=1000.0).contains(&hz) => {
                    Ok(Self::Rate { period: Duration::from_secs_f64(1.0 / hz) })
                }
                _ => Err(wrong()),
            },
            Some(("quality", share)) => match number(share)? {
                share if share > 0.0 && share <= 1.0 => Ok(Self::Quality { share }),
                _ => Err(wrong()),
            },
            _ => Err(wrong()),
        }
    }
}

/// μ(s) = tan(s π/2) (STE section 4.3): nothing at 0, as much as the other error at 1/2, everything at 1.
pub(crate) fn weight(s: f64) -> f64 {
    if s < 1.0 { (s * FRAC_PI_2).tan() } else { f64::INFINITY }
}

/// A weight times an error; nothing of either is nothing.
pub(crate) fn weighed(s: f64, error: f64) -> f64 {
    if error == 0.0 { 0.0 } else { weight(s) * error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_the_paper() {
        assert_eq!(weight(0.0), 0.0);
        assert!((weight(0.5) - 1.0).abs() < 1e-12);
        assert!((weight(0.6) - 1.376).abs() < 1e-3);
        assert_eq!(weighed(1.0, 0.0), 0.0);
        assert_eq!(weighed(1.0, 1e-9), f64::INFINITY);
    }

    #[test]
    fn rules_are_read_and_refused() {
        assert_eq!("errors".parse(), Ok(Rule::default()));
        assert_eq!("rate=10".parse(), Ok(Rule::Rate { period: Duration::from_millis(100) }));
        assert_eq!("quality=0.2".parse(), Ok(Rule::Quality { share: 0.2 }));
        for wrong in ["", "rate", "rate=0", "rate=nan", "quality=0", "quality=1.1", "errors=1", "speed=3"] {
            assert!(wrong.parse::<Rule>().is_err(), "{wrong}");
        }
    }
}
