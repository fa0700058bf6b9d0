//! The limits of a smoothstep.

use serde::{Deserialize, Serialize};

/// Limits of a smoothstep: 0 up to `low`, 1 from `high` on; finite, `low` below `high`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ramp {
    /// Where it leaves 0.
    pub low: f64,
    /// Where it reaches 1.
    pub high: f64,
}

impl Ramp {
    /// The smoothstep at `x`.
    pub fn at(&self, x: f64) -> f64 {
        let t = ((x - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}
