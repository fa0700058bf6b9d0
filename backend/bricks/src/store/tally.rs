//! Errors, summed.

/// Largest and weighted mean square error, in data units.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ErrorTally {
    pub max: f64,
    /// Sum of squares, each weighted by the voxels of the source that it stands for.
    pub squares: f64,
}

impl ErrorTally {
    pub fn merge(&mut self, other: Self) {
        self.max = self.max.max(other.max);
        self.squares += other.squares;
    }

    /// Of so many voxels of the source.
    pub fn rms(&self, voxels: u64) -> f64 {
        (self.squares / voxels.max(1) as f64).sqrt()
    }
}
