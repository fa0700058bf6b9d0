//! What reading a volume means: a description, and its slabs of constant z one after the other.

use super::{Element, VolumeError};
use glam::{DVec3, UVec3};

/// Largest number of voxels along an axis that is believed.
pub const MAX_EDGE_VOXELS: u32 = 1 << 20;

/// What is known of a volume before its voxels are read.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeInfo {
    /// The file's name, or the procedural volume's.
    pub name: String,
    /// Voxels along x, y, z; each from 1 to [`MAX_EDGE_VOXELS`].
    pub dims: UVec3,
    /// Edge lengths of a voxel in metres, each positive.
    pub voxel_size_m: DVec3,
    /// How the voxels are stored; a procedural volume says [`Element::F64`].
    pub element: Element,
    /// Whether NaN and infinity cannot occur.
    pub all_finite: bool,
}

impl VolumeInfo {
    /// Voxels of one slab.
    pub fn slab_voxels(&self) -> usize {
        self.dims.x as usize * self.dims.y as usize
    }

    /// Voxels of the volume.
    pub fn voxels(&self) -> u64 {
        self.slab_voxels() as u64 * u64::from(self.dims.z)
    }

    /// Bytes of the voxels as they are stored.
    pub fn bytes(&self) -> u64 {
        self.voxels() * self.element.bytes() as u64
    }
}

/// A volume that can be read slab by slab; at no time is more than one slab of it in memory.
pub trait VolumeReader: Send {
    /// What is known before reading.
    fn info(&self) -> &VolumeInfo;

    /// Reads the voxels of constant `z` into `slab`, x fastest, [`VolumeInfo::slab_voxels`] of them, in data units.
    /// Cheap when `z` follows the slab read before; any other `z` may decompress from the start.
    fn read_slab(&mut self, z: u32, slab: &mut [f64]) -> Result<(), VolumeError>;
}

impl std::fmt::Debug for dyn VolumeReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.info().fmt(f)
    }
}
