//! How closely a kernel follows the continuous optical model.

use serde::{Deserialize, Serialize};

/// The knobs that trade time for error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Longest integration step, in voxels of the node being sampled; above 0.
    pub step_voxels: f64,
    /// Error of colour and opacity that a step may have by its own estimate before it is cut into parts; above 0,
    /// infinite for steps of one length.
    pub tolerance: f64,
    /// A ray stops when what may still be added is below this opacity; 0 never stops early.
    pub termination: f64,
    /// A node is fine enough when its voxel is no longer than `lod_scale` times the display's resolution s(z);
    /// 0 always asks for the finest level.
    pub lod_scale: f64,
    /// Whether scalars and gradients are filtered over node, parent and grandparent. With λ = log2(lod_scale · s(z) /
    /// longest edge of the finest voxel) levels above the finest and a node ℓ levels above it, the sample is
    /// S(clamp(λ − ℓ, 0, 2)), linear between node (0), parent (1) and grandparent (2), constant from the coarsest
    /// ancestor on. A node that shows nothing by its own values shows nothing.
    pub quadrilinear: bool,
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            step_voxels: 0.4,
            tolerance: 1e-4,
            termination: 1.0 / 1024.0,
            lod_scale: 1.0,
            quadrilinear: false,
        }
    }
}
