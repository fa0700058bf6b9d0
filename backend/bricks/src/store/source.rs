//! Where bricks come from: a store file, or a procedural volume made on the fly.

use crate::volume::{Modality, VolumeFrame};
use crate::{Brick, NodeKey, OctreeShape};
use glam::DVec3;
use optics::Optics;

/// What is known of a node without reading its voxels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeSummary {
    /// No stored sample of the node, nor of any node below it, has a lower data value.
    pub min: f32,
    /// No stored sample of the node, nor of any node below it, has a higher data value.
    pub max: f32,
}

/// Why a brick could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{sentence}")]
pub struct BrickError {
    /// One sentence that names the file and the brick.
    pub sentence: String,
    /// Whether asking for it again makes sense.
    pub kind: BrickErrorKind,
}

/// Whether a brick that could not be read may be readable later.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrickErrorKind {
    /// What was read is not a brick: another read finds the same.
    Damaged,
    /// It could not be read: the disk or the network may answer later.
    Unavailable,
}

impl BrickError {
    /// What was read is not a brick.
    pub fn damaged(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), kind: BrickErrorKind::Damaged }
    }

    /// The brick could not be read this time.
    pub fn unavailable(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), kind: BrickErrorKind::Unavailable }
    }
}

/// A volume as an octree of bricks. Cheap to ask from many threads at once.
pub trait BrickSource: Send + Sync {
    /// The octree's geometry.
    fn shape(&self) -> OctreeShape;
    /// Size, orientation and place of the finest voxels, as the data's own file gives them (1 mm where it gives none).
    fn frame(&self) -> VolumeFrame;
    /// Edge lengths of the finest voxel in metres.
    fn voxel_size_m(&self) -> DVec3 {
        self.frame().voxel_size_m()
    }
    /// What the volume was taken by, as the data's own file says.
    fn modality(&self) -> Modality {
        Modality::Unknown
    }
    /// Whether bricks of coarse levels have standard deviations.
    fn has_deviation(&self) -> bool {
        false
    }
    /// Smallest and largest data value of the whole volume.
    fn value_range(&self) -> (f64, f64);
    /// Bounds of a node's values; `node` must be one that [`OctreeShape::contains`].
    fn summary(&self, node: NodeKey) -> NodeSummary;
    /// The node's voxels.
    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError>;
}

/// Whether transfer functions show any value between a node's bounds.
pub fn is_shown(optics: &Optics, NodeSummary { min, max }: NodeSummary) -> bool {
    !optics.is_empty_on(f64::from(min), f64::from(max))
}
