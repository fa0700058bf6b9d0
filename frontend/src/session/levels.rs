//! The errors of a store's levels, for reports.

use bricks::store::LevelError;
use serde::Serialize;

/// How far one level of a store is from the source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LevelSummary {
    /// Which level, 0 = finest.
    pub level: usize,
    /// Root mean square over all voxels of the source, data units.
    pub rms_error: f64,
    /// The largest difference, data units.
    pub max_error: f64,
}

impl LevelSummary {
    /// Of levels, the finest first.
    pub fn all(levels: &[LevelError]) -> Vec<Self> {
        let numbered = levels.iter().enumerate();
        numbered.map(|(level, error)| Self { level, rms_error: error.rms, max_error: error.max }).collect()
    }
}
