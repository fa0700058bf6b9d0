//! Where the voxels of a file lie in the space that the file names.

use glam::{DMat3, DVec3};

/// Volume that three unit vectors span at least where they are taken to span a space.
const FLATTEST: f64 = 1e-6;
/// So many times as long as the shortest edge of a voxel is the longest at most. Far beyond any scanner's, it is near
/// what rays in single precision can cross.
const MOST_STRETCHED: f64 = 1e6;

/// What the axes of a file's space are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Nothing is said of them: the volume's own axes are all there is.
    Unknown,
    /// A patient's: x to the left hand, y to the back, z to the head (L, P, S: the axes of DICOM and ITK).
    Patient,
}

/// Position, spacing and orientation of a volume. Voxel (i, j, k) has its centre at `origin_m + axes_m * (i, j, k)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeFrame {
    /// Metres from a voxel to the next one along x, y, z (columns): lengths are the voxel's edges; a mirrored or
    /// sheared volume has a negative determinant or columns that are not orthogonal.
    pub axes_m: DMat3,
    /// Centre of the first voxel, metres.
    pub origin_m: DVec3,
    /// What the axes are.
    pub space: Space,
}

impl VolumeFrame {
    /// What is asked of a voxel's edges, as the end of a sentence.
    pub const SOUND_EDGES: &str = "each edge must be positive, and none a million times as long as another";

    /// A volume of which only the voxels' edges are known.
    pub fn of_voxels(voxel_size_m: DVec3) -> Self {
        Self { axes_m: DMat3::from_diagonal(voxel_size_m), origin_m: DVec3::ZERO, space: Space::Unknown }
    }

    /// Edges of a voxel, metres.
    pub fn voxel_size_m(&self) -> DVec3 {
        let [x, y, z] = [self.axes_m.x_axis, self.axes_m.y_axis, self.axes_m.z_axis].map(DVec3::length);
        DVec3::new(x, y, z)
    }

    /// Directions of the voxels' edges: unit vectors as columns.
    pub fn directions(&self) -> DMat3 {
        let axes = &self.axes_m;
        DMat3::from_cols(axes.x_axis.normalize(), axes.y_axis.normalize(), axes.z_axis.normalize())
    }

    /// The same place and directions with voxels of other edges, metres; where the directions cannot be, the axes'.
    pub fn with_voxel_size(&self, voxel_size_m: DVec3) -> Self {
        let directions = self.directions();
        if !directions.is_finite() || directions.determinant().abs() <= FLATTEST {
            return Self::of_voxels(voxel_size_m);
        }
        Self { axes_m: directions * DMat3::from_diagonal(voxel_size_m), ..*self }
    }

    /// Whether a volume can lie so: finite numbers, edges as [`Self::SOUND_EDGES`] says, and axes that span a space.
    pub fn is_sound(&self) -> bool {
        let size = self.voxel_size_m();
        self.axes_m.is_finite()
            && self.origin_m.is_finite()
            && size.is_finite()
            && size.min_element() > 0.0
            && size.max_element() <= MOST_STRETCHED * size.min_element()
            && self.directions().determinant().abs() > FLATTEST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_knows_its_voxels_and_directions() {
        let frame = VolumeFrame {
            axes_m: DMat3::from_cols(DVec3::Y * 2e-3, DVec3::X * 1e-3, DVec3::Z * -3e-3),
            ..VolumeFrame::of_voxels(DVec3::ONE)
        };
        assert_eq!(frame.voxel_size_m(), DVec3::new(2e-3, 1e-3, 3e-3));
        assert!((frame.directions().determinant() - 1.0).abs() < 1e-12);
        assert!(frame.is_sound());
    }

    #[test]
    fn other_voxels_keep_the_directions() {
        let frame = VolumeFrame {
            axes_m: DMat3::from_cols(DVec3::Y * 2e-3, DVec3::X * 1e-3, DVec3::Z * -3e-3),
            origin_m: DVec3::ONE,
            space: Space::Patient,
        };
        let other = frame.with_voxel_size(DVec3::splat(5e-3));
        assert_eq!(other.axes_m, DMat3::from_cols(DVec3::Y, DVec3::X, -DVec3::Z) * 5e-3);
        assert_eq!((other.origin_m, other.space), (frame.origin_m, frame.space));
        let unknown = VolumeFrame::of_voxels(DVec3::new(0.0, 1.0, f64::NAN));
        assert_eq!(unknown.with_voxel_size(DVec3::ONE), VolumeFrame::of_voxels(DVec3::ONE));
    }

    #[test]
    fn flat_and_infinite_frames_are_unsound() {
        assert!(!VolumeFrame::of_voxels(DVec3::new(1.0, 0.0, 1.0)).is_sound());
        assert!(!VolumeFrame::of_voxels(DVec3::splat(f64::NAN)).is_sound());
        for thin in [1e-37, 1e-7] {
            assert!(!VolumeFrame::of_voxels(DVec3::new(1.0, thin, 1.0)).is_sound(), "{thin}");
            assert!(VolumeFrame::of_voxels(DVec3::splat(thin)).is_sound(), "{thin}");
        }
        assert!(VolumeFrame::of_voxels(DVec3::new(1e-3, 1e-9, 1e-6)).is_sound());
        let flat = DMat3::from_cols(DVec3::X, DVec3::X, DVec3::Z);
        assert!(!VolumeFrame { axes_m: flat, ..VolumeFrame::of_voxels(DVec3::ONE) }.is_sound());
    }
}
