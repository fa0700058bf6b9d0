//! What reading a volume means: a description, and its slabs of constant z one after the other.

use super::{Element, Modality, Samples, VolumeError, VolumeFrame};
use glam::UVec3;

/// Largest number of voxels along an axis that is believed.
pub const MAX_EDGE_VOXELS: u32 = 1 << 20;

/// What is known of a volume before its voxels are read.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeInfo {
    /// The file's name, or the procedural volume's.
    pub name: String,
    /// Voxels along x, y, z; each from 1 to [`MAX_EDGE_VOXELS`].
    pub dims: UVec3,
    /// Size, orientation and place of the voxels; sound as [`VolumeFrame::is_sound`] says.
    pub frame: VolumeFrame,
    /// What it was taken by.
    pub modality: Modality,
    /// The type of the stored numbers.
    pub element: Element,
    /// Data value = slope × stored number + intercept; finite, the slope not 0.
    pub slope: f64,
    /// See `slope`.
    pub intercept: f64,
}

impl VolumeInfo {
    /// A volume whose stored numbers are its values, of unknown modality.
    pub fn unscaled(name: impl Into<String>, dims: UVec3, frame: VolumeFrame, element: Element) -> Self {
        let modality = Modality::Unknown;
        Self { name: name.into(), dims, frame, modality, element, slope: 1.0, intercept: 0.0 }
    }

    /// Voxels of one slab.
    pub fn slab_voxels(&self) -> usize {
        self.dims.x as usize * self.dims.y as usize
    }

    /// Voxels of the volume.
    pub fn voxels(&self) -> u64 {
        self.slab_voxels() as u64 * u64::from(self.dims.z)
    }

    /// Bytes of the voxels as they are stored, unpacked.
    pub fn bytes(&self) -> u64 {
        self.voxels() * self.element.bytes() as u64
    }

    /// The data value of a stored number.
    pub fn value(&self, stored: f64) -> f64 {
        stored * self.slope + self.intercept
    }

    /// Whether the stored numbers are the data values.
    pub fn is_unscaled(&self) -> bool {
        (self.slope, self.intercept) == (1.0, 0.0)
    }

    /// Whether NaN, infinity and numbers beyond f32 cannot occur.
    pub fn is_all_finite(&self) -> bool {
        let largest = self.slope.abs() * u64::MAX as f64 + self.intercept.abs();
        !self.element.is_float() && largest < f64::from(f32::MAX)
    }
}

/// A volume that can be read slab by slab; at no time is the whole of it in memory.
pub trait VolumeReader: Send {
    /// What is known before reading.
    fn info(&self) -> &VolumeInfo;

    /// Reads the stored numbers of constant `z` into `slab`: x fastest, [`VolumeInfo::slab_voxels`] of them, of
    /// [`VolumeInfo::element`]. Cheap when `z` follows the slab read before; any other `z` may decompress from the
    /// start.
    ///
    /// # Errors
    /// What is wrong with the file, found only now.
    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError>;
}

impl std::fmt::Debug for dyn VolumeReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.info().fmt(f)
    }
}
