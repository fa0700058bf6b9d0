//! What is asked of an export, and what it did.

use bricks::volume::Element;
use glam::UVec3;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// What to export, and how.
#[derive(Clone, Debug, Default)]
pub struct ExportOptions {
    /// Level, 0 = finest. None is the finest; of OME-Zarr all levels, where no part is asked for.
    pub level: Option<u8>,
    /// First voxel of the part, in voxels of the level; None is the level's first.
    pub low: Option<UVec3>,
    /// Voxels of the part along x, y, z; None reaches to the level's end.
    pub size: Option<UVec3>,
    /// The type of the numbers, to which they are rounded; None is the smallest that keeps them all as they are in the
    /// store: f32, or integers of up to 32 bits where there are no others.
    pub element: Option<Element>,
    /// Whether an NRRD file is packed with gzip; OME-Zarr is always packed.
    pub is_packed: bool,
    /// The export ends with an error soon after this becomes true.
    pub stop: Option<Arc<AtomicBool>>,
}

/// What an export did.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportReport {
    /// Voxels along x, y, z of each level that was written, the finest first.
    pub levels: Vec<UVec3>,
    /// The type of the numbers.
    pub element: Element,
    /// Bytes of what was written.
    pub bytes: u64,
    /// Whether the volume's directions in space are lost: OME-Zarr 0.5 keeps none.
    pub has_lost_directions: bool,
    /// Time it took.
    pub duration: Duration,
}
