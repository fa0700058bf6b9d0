//! Where a volume floats.

use super::VolumeAxes;
use bricks::volume::{Space, VolumeFrame};
use display_config::Display;
use glam::{DAffine3, DMat3, DQuat, DVec3, UVec3};

/// How large a volume is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// Its longest edge, metres.
    LongestM(f64),
    /// Metres of the display per metre of the data.
    Scale(f64),
    /// Its longest edge as a part of the screen's shorter one: the default, on any display.
    ScreenShare(f64),
}

/// Place, turn and size of a volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where its centre is, display frame, metres.
    pub centre_m: DVec3,
    /// Its turn about the centre, after the axes were laid out.
    pub rotation: DQuat,
    /// Which way it stands. What they leave open is as the volume itself says: a patient upright and facing the viewers, and
    /// any other volume with the axes of its file's space to the right, up and to the viewers.
    pub axes: VolumeAxes,
    /// Its size.
    pub size: Size,
}

impl Default for Placement {
    /// In the middle of the screen, half of it in front, three quarters as high as the screen.
    fn default() -> Self {
        let size = Size::ScreenShare(0.75);
        Self { centre_m: DVec3::ZERO, rotation: DQuat::IDENTITY, axes: VolumeAxes::default(), size }
    }
}

impl Placement {
    /// Metres of the display per metre of the data, for data of `extent_m`.
    pub fn scale(&self, extent_m: DVec3, display: &Display) -> f64 {
        match self.size {
            Size::Scale(scale) => scale,
            Size::LongestM(longest_m) => longest_m / extent_m.max_element(),
            Size::ScreenShare(share) => {
                share * display.width_m.min(display.height_m) / extent_m.max_element()
            }
        }
    }

    /// Volume frame (voxels of `voxel_m` in the display) to display frame; the volume's centre goes to `centre_m`. Of
    /// `frame`, the directions count, mirrored and sheared ones as they are, where the scene does not name axes.
    pub fn display_from_volume(&self, dims: UVec3, voxel_m: DVec3, frame: &VolumeFrame) -> DAffine3 {
        let own = match frame.space {
            Space::Patient => upright_from_patient() * frame.directions(),
            Space::Unknown => frame.directions(),
        };
        let stand = if self.axes.is_open() { own } else { self.axes.display_from_volume(own) };
        let linear = DMat3::from_quat(self.rotation) * stand * DMat3::from_diagonal(voxel_m);
        let centre_in_volume = 0.5 * dims.as_dvec3();
        DAffine3::from_mat3_translation(linear, self.centre_m - linear * centre_in_volume)
    }
}

/// A patient (x to the left hand, y to the back, z to the head) who stands and faces the viewers: the head is up, and
/// the left hand at the viewers' right.
fn upright_from_patient() -> DMat3 {
    DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y)
}

/// Degrees about the display's x, then y, then z axis.
pub(super) fn rotation_from_deg(deg: DVec3) -> DQuat {
    let about = |axis, deg: f64| DQuat::from_axis_angle(axis, deg.to_radians());
    about(DVec3::Z, deg.z) * about(DVec3::Y, deg.y) * about(DVec3::X, deg.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIMS: UVec3 = UVec3::new(256, 256, 108);
    const SPACING_M: DVec3 = DVec3::new(0.957e-3, 0.957e-3, 1.5e-3);

    #[test]
    fn the_centre_stays_and_the_spacing_counts() {
        let place = Placement {
            centre_m: DVec3::new(0.1, 0.2, 0.3),
            size: Size::LongestM(0.7),
            ..Default::default()
        };
        let frame = VolumeFrame::of_voxels(SPACING_M);
        let scale = 0.7 / (DIMS.as_dvec3() * SPACING_M).max_element();
        let map = place.display_from_volume(DIMS, SPACING_M * scale, &frame);
        assert!((map.transform_point3(0.5 * DIMS.as_dvec3()) - place.centre_m).length() < 1e-15);
        let edge = |axis: DVec3| map.transform_vector3(axis * DIMS.as_dvec3()).length();
        assert!((edge(DVec3::X) - 0.7).abs() < 1e-12);
        assert!((edge(DVec3::Z) / edge(DVec3::X) - 108.0 * 1.5 / (256.0 * 0.957)).abs() < 1e-12);
    }

    #[test]
    fn rotations_turn_about_x_before_y() {
        let turned = rotation_from_deg(DVec3::new(90.0, 90.0, 0.0)) * DVec3::Y;
        assert!((turned - DVec3::X).length() < 1e-12, "{turned}");
    }
}
