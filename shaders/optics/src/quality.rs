//! How closely a kernel follows the continuous optical model.

use super::bounds::{OutOfBounds, held};
use serde::{Deserialize, Serialize};

/// The knobs that trade time for error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Integration step, in voxels of the node being sampled, where the optical depth of such a step is not small; above 0.
    /// In thinner media steps grow, up to one voxel, or up to four where `tolerance` is loose; where the error calls for it, they
    /// are split.
    pub step_voxels: f64,
    /// Estimated error of colour and opacity above which a step is split into parts; above 0, and 1 or more for steps of
    /// one length.
    pub tolerance: f64,
    /// A ray stops when less than this opacity can still be added; 0 never stops early.
    pub termination: f64,
    /// A node is fine enough if its voxel is at most `lod_scale` times the display's resolution s(z);
    /// 0 always asks for the finest level.
    pub lod_scale: f64,
    /// Whether scalars and gradients are filtered over node, parent and grandparent. With λ = log2(lod_scale · s(z) /
    /// longest edge of the finest voxel) levels above the finest and a node ℓ levels above it, the sample is
    /// S(clamp(λ − ℓ, 0, 2)), linear between node (0), parent (1) and grandparent (2), constant from the coarsest
    /// ancestor on. A node that shows nothing by its own values shows nothing.
    pub quadrilinear: bool,
    /// Whether samples blend into the parent's toward coarser neighbours and while detail appears or goes, so that no
    /// border between bricks shows.
    pub blended: bool,
    /// Whether a coarse voxel is taken as all that it stands for, where its volume keeps standard deviations: extinction and
    /// colour are then means over the scalars within one deviation of the voxel's mean.
    pub deviation: bool,
}

impl Quality {
    /// The shortest and the longest `step_voxels`. Shorter ones add less to a ray than it can hold in f32; longer ones
    /// are of no use.
    pub const STEPS_VOXELS: (f64, f64) = (1e-4, 16.0);
    /// The smallest `tolerance`: f32 holds no less.
    pub const LEAST_TOLERANCE: f64 = 1e-9;

    /// Checks what the types do not.
    pub fn check(&self) -> Result<(), OutOfBounds> {
        let (shortest, longest) = Self::STEPS_VOXELS;
        let step = self.step_voxels;
        held((shortest..=longest).contains(&step), "step_voxels", step, "a number from 0.0001 to 16")?;
        let tolerance = self.tolerance >= Self::LEAST_TOLERANCE;
        held(tolerance, "tolerance", self.tolerance, "a number of at least 1e-9")?;
        let share = (0.0..=1.0).contains(&self.termination);
        held(share, "termination", self.termination, "a number from 0 to 1")?;
        let scale = (0.0..=1e6).contains(&self.lod_scale);
        held(scale, "lod_scale", self.lod_scale, "a number from 0 to 1e6")
    }
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            step_voxels: 0.4,
            tolerance: 1e-4,
            termination: 1.0 / 4096.0,
            lod_scale: 1.0,
            quadrilinear: false,
            blended: true,
            deviation: true,
        }
    }
}
