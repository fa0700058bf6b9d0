//! How to build a store, and what a build did.

use super::{CodeBits, Codec};
use glam::UVec3;
use optics::Optics;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Which bricks are not worth keeping: they read back as their smallest value everywhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Emptiness {
    /// Only bricks whose samples are all equal, which lose nothing.
    #[default]
    Lossless,
    /// Bricks whose largest value is below this one.
    Below(f64),
    /// Bricks that none of these looks shows.
    Invisible(Vec<Optics>),
}

impl Emptiness {
    /// Whether a brick with values between these is left out.
    pub(super) fn applies(&self, low: f32, high: f32) -> bool {
        match self {
            Emptiness::Lossless => false,
            Emptiness::Below(least) => f64::from(high) < *least,
            Emptiness::Invisible(looks) => {
                looks.iter().all(|optics| optics.is_empty_on(f64::from(low), f64::from(high)))
            }
        }
    }
}

/// How to build.
#[derive(Clone, Debug)]
pub struct BuildOptions {
    /// Bits per code.
    pub bits: CodeBits,
    /// Compression of the bricks.
    pub codec: Codec,
    /// Memory for slabs: those being read, and the last ones of all levels, of which what does not fit is kept in working
    /// files beside the store. Beyond it, a build takes some 110 bytes per brick that is not one value.
    pub memory_bytes: u64,
    /// Which bricks are left out.
    pub emptiness: Emptiness,
    /// Whether coarse levels keep the standard deviation of what their voxels stand for, beside its mean.
    pub has_deviation: bool,
    /// The build ends with an error soon after this becomes true.
    pub stop: Option<Arc<AtomicBool>>,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            bits: CodeBits::Eight,
            codec: Codec::Lz4,
            memory_bytes: 2 << 30,
            emptiness: Emptiness::Lossless,
            has_deviation: true,
            stop: None,
        }
    }
}

/// How far a level is from the source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelError {
    /// Root mean square over all voxels of the source, of the difference to the level's voxel around them, data units.
    pub rms: f64,
    /// The largest difference.
    pub max: f64,
}

/// What a build did.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildReport {
    /// Voxels of the source along each axis.
    pub dims: UVec3,
    /// Nodes of the octree, and those that took any bytes; all samples of the others are equal.
    pub nodes: u64,
    /// See `nodes`.
    pub stored_bricks: u64,
    /// Bricks left out by [`BuildOptions::emptiness`] that were not of one value.
    pub emptied_bricks: u64,
    /// Bytes of the source's voxels, unpacked.
    pub source_bytes: u64,
    /// Bytes of the store.
    pub store_bytes: u64,
    /// Root mean square error of the finest level against the source, in data units; an upper bound where the
    /// source's values are not exact in f32, where the rounding's own RMS is added.
    pub rms_error: f64,
    /// Largest error of the finest level, in data units, with the same remark.
    pub max_error: f64,
    /// Errors of all levels, the finest first, with the same remark.
    pub levels: Vec<LevelError>,
    /// Voxels that were NaN, infinite or beyond f32, and were replaced by the smallest or largest finite value.
    pub non_finite: u64,
    /// Smallest and largest finite value.
    pub value_range: (f64, f64),
    /// Time it took.
    pub duration: Duration,
}
