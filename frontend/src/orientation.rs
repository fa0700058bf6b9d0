//! Which way a volume's axes point, in the few words that people and programs read.

use bricks::volume::{Space, VolumeFrame};
use glam::{DMat3, DVec3};
use serde::Serialize;

/// The six directions of a patient with their letters, in the axes of DICOM: x to the left hand, y to the back, z to
/// the head.
const LETTERS: [(char, DVec3); 6] = [
    ('L', DVec3::X),
    ('R', DVec3::NEG_X),
    ('P', DVec3::Y),
    ('A', DVec3::NEG_Y),
    ('S', DVec3::Z),
    ('I', DVec3::NEG_Z),
];

/// An axis that deviates from a patient's direction by more than this is reported with its angle, degrees.
const STRAIGHT_DEG: f64 = 0.5;

/// A volume's frame, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameFacts {
    /// Edge lengths of a voxel, metres.
    pub voxel_size_m: DVec3,
    /// Whether the file says how its patient lies.
    pub is_orientation_known: bool,
    /// Directions of the voxels' x, y and z axes (unit vectors) in the file's space: for a patient, x to the left hand,
    /// y to the back, z to the head.
    pub directions: [DVec3; 3],
    /// Centre of the first voxel, metres.
    pub origin_m: DVec3,
    /// The same in words: see [`describe`].
    pub orientation: String,
}

impl FrameFacts {
    /// The facts of a frame.
    pub fn of(frame: &VolumeFrame) -> Self {
        let turn = frame.directions();
        Self {
            voxel_size_m: frame.voxel_size_m(),
            is_orientation_known: frame.space == Space::Patient,
            directions: [turn.x_axis, turn.y_axis, turn.z_axis],
            origin_m: frame.origin_m,
            orientation: describe(frame),
        }
    }
}

/// For a patient, where each voxel axis points, such as `x to L, y to P, z to S`, with the angle where it is oblique:
/// L and R are the patient's left and right, A and P the front and back, S and I the head and feet.
pub fn describe(frame: &VolumeFrame) -> String {
    let turn = frame.directions();
    let words = match frame.space {
        Space::Patient => ['x', 'y', 'z'].iter().zip(columns(&turn)).map(patient_axis).collect::<Vec<_>>(),
        Space::Unknown if turn == DMat3::IDENTITY => return "unknown, the volume's own axes".to_owned(),
        Space::Unknown => return "unknown, turned within the file's own space".to_owned(),
    };
    let mirrored = if turn.determinant() < 0.0 { ", mirrored" } else { "" };
    format!("{}{mirrored}", words.join(", "))
}

fn columns(turn: &DMat3) -> [DVec3; 3] {
    [turn.x_axis, turn.y_axis, turn.z_axis]
}

fn patient_axis((name, direction): (&char, DVec3)) -> String {
    let nearest = LETTERS.iter().max_by(|a, b| direction.dot(a.1).total_cmp(&direction.dot(b.1)));
    let &(letter, toward) = nearest.expect("there are six directions");
    let off_deg = direction.dot(toward).clamp(-1.0, 1.0).acos().to_degrees();
    if off_deg > STRAIGHT_DEG {
        format!("{name} to {letter} ({off_deg:.0}° off)")
    } else {
        format!("{name} to {letter}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patient(x: DVec3, y: DVec3, z: DVec3) -> String {
        let axes_m = 1e-3 * DMat3::from_cols(x, y, z);
        describe(&VolumeFrame { axes_m, origin_m: DVec3::ZERO, space: Space::Patient })
    }

    #[test]
    fn axes_are_named_by_where_they_point() {
        assert_eq!(patient(DVec3::X, DVec3::Y, DVec3::Z), "x to L, y to P, z to S");
        assert_eq!(patient(DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z), "x to R, y to A, z to S");
        assert_eq!(patient(DVec3::Y, DVec3::NEG_Z, DVec3::X), "x to P, y to I, z to L, mirrored");
        let (sin, cos) = 12_f64.to_radians().sin_cos();
        let tilted = patient(DVec3::X, DVec3::new(0.0, cos, sin), DVec3::new(0.0, -sin, cos));
        assert_eq!(tilted, "x to L, y to P (12° off), z to S (12° off)");
    }

    #[test]
    fn what_no_file_says_is_not_made_up() {
        let facts = FrameFacts::of(&VolumeFrame::of_voxels(DVec3::new(1e-3, 1e-3, 2e-3)));
        assert!(!facts.is_orientation_known && facts.orientation.starts_with("unknown"));
        assert_eq!(facts.voxel_size_m, DVec3::new(1e-3, 1e-3, 2e-3));
    }
}
