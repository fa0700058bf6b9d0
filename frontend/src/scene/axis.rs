//! How the data's axes lie in the display.

use glam::{DMat3, DVec3};
use serde::Deserialize;

/// A signed axis of the volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum VolumeAxis {
    /// Rising x.
    #[serde(rename = "+x")]
    PlusX,
    /// Falling x.
    #[serde(rename = "-x")]
    MinusX,
    /// Rising y.
    #[serde(rename = "+y")]
    PlusY,
    /// Falling y.
    #[serde(rename = "-y")]
    MinusY,
    /// Rising z.
    #[serde(rename = "+z")]
    PlusZ,
    /// Falling z.
    #[serde(rename = "-z")]
    MinusZ,
}

impl VolumeAxis {
    /// Its unit vector in the volume frame.
    pub fn direction(self) -> DVec3 {
        match self {
            VolumeAxis::PlusX => DVec3::X,
            VolumeAxis::MinusX => DVec3::NEG_X,
            VolumeAxis::PlusY => DVec3::Y,
            VolumeAxis::MinusY => DVec3::NEG_Y,
            VolumeAxis::PlusZ => DVec3::Z,
            VolumeAxis::MinusZ => DVec3::NEG_Z,
        }
    }
}

/// Which directions of the volume point right, up and to the viewers: three perpendicular axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeAxes {
    right: DVec3,
    up: DVec3,
    front: DVec3,
}

impl VolumeAxes {
    /// From the axes that point up and to the viewers. `right` is their cross product unless it is given: data that
    /// were stored mirrored need the other one. None if two lie along one line.
    pub fn new(up: VolumeAxis, front: VolumeAxis, right: Option<VolumeAxis>) -> Option<Self> {
        let (up, front) = (up.direction(), front.direction());
        let right = right.map_or(up.cross(front), VolumeAxis::direction);
        let volume = right.dot(up.cross(front));
        (volume.abs() == 1.0).then_some(Self { right, up, front })
    }

    /// Turns a direction of the volume into one of the display.
    pub fn display_from_volume(&self) -> DMat3 {
        DMat3::from_cols(self.right, self.up, self.front).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_and_front_go_where_they_say() {
        let axes = VolumeAxes::new(VolumeAxis::PlusZ, VolumeAxis::MinusY, None).unwrap();
        let turn = axes.display_from_volume();
        assert_eq!(turn * DVec3::Z, DVec3::Y);
        assert_eq!(turn * DVec3::NEG_Y, DVec3::Z);
        assert_eq!(turn.determinant(), 1.0);
    }

    #[test]
    fn a_given_right_may_mirror_but_not_collapse() {
        let mirrored =
            VolumeAxes::new(VolumeAxis::PlusZ, VolumeAxis::PlusY, Some(VolumeAxis::PlusX)).unwrap();
        assert_eq!(mirrored.display_from_volume().determinant(), -1.0);
        assert_eq!(VolumeAxes::new(VolumeAxis::PlusZ, VolumeAxis::MinusZ, None), None);
        assert_eq!(VolumeAxes::new(VolumeAxis::PlusZ, VolumeAxis::PlusY, Some(VolumeAxis::MinusY)), None);
    }
}
