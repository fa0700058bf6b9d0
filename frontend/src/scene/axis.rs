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

/// Which axes of the volume point right, up and to the viewers, as far as a scene says: no two along one line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VolumeAxes {
    right: Option<VolumeAxis>,
    up: Option<VolumeAxis>,
    front: Option<VolumeAxis>,
}

const ALL: [VolumeAxis; 6] = [
    VolumeAxis::PlusX,
    VolumeAxis::PlusY,
    VolumeAxis::PlusZ,
    VolumeAxis::MinusX,
    VolumeAxis::MinusY,
    VolumeAxis::MinusZ,
];

/// What counts of the volume's own word where not all of it can be kept: first who faces the viewers, then what is up, then
/// what is at their right.
const WEIGHTS: DVec3 = DVec3::new(1.0, 2.0, 4.0);

impl VolumeAxes {
    /// None if two of those that are given lie along one line.
    pub fn new(up: Option<VolumeAxis>, front: Option<VolumeAxis>, right: Option<VolumeAxis>) -> Option<Self> {
        let given = [right, up, front].map(|axis| axis.map(VolumeAxis::direction));
        let is_line = |a: Option<DVec3>, b: Option<DVec3>| a.zip(b).is_some_and(|(a, b)| a.dot(b) != 0.0);
        let [r, u, f] = given;
        let is_flat = is_line(r, u) || is_line(u, f) || is_line(f, r);
        (!is_flat).then_some(Self { right, up, front })
    }

    /// Turns a direction of the volume into one of the display. `own` is how the volume itself stands: it says what the
    /// scene leaves open, as far as that goes with what the scene says, and whether voxels are stored mirrored.
    pub fn display_from_volume(&self, own: DMat3) -> DMat3 {
        let Self { right, up, front } = *self;
        let choices =
            |given: Option<VolumeAxis>| ALL.into_iter().filter(move |axis| given.is_none_or(|g| g == *axis));
        let is_complete = right.is_some() && up.is_some() && front.is_some();
        let stands = choices(right)
            .flat_map(|r| choices(up).flat_map(move |u| choices(front).map(move |f| [r, u, f])));
        let stands = stands.map(|axes| {
            let [r, u, f] = axes.map(VolumeAxis::direction);
            DMat3::from_cols(r, u, f).transpose()
        });
        let is_possible = |stand: &DMat3| {
            let volume = stand.determinant();
            volume.abs() == 1.0 && (is_complete || volume == own.determinant().signum())
        };
        let rows = |stand: &DMat3| [stand.row(0), stand.row(1), stand.row(2)];
        let kept = |stand: &DMat3| {
            let shares =
                rows(stand).into_iter().zip(rows(&own)).map(|(row, own)| row.dot(own.normalize_or_zero()));
            WEIGHTS.to_array().into_iter().zip(shares).map(|(weight, share)| weight * share).sum::<f64>()
        };
        let stands = stands.filter(is_possible);
        stands.max_by(|a, b| kept(a).total_cmp(&kept(b))).unwrap_or(own)
    }

    /// Whether the scene says nothing.
    pub fn is_open(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::VolumeAxis::{MinusX, MinusY, MinusZ, PlusX, PlusY, PlusZ};
    use super::*;

    /// A patient whose rows go to the left hand, columns to the back and slices to the head.
    const PATIENT: DMat3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);

    type Given = Option<VolumeAxis>;

    /// Which axes of the volume point right, up and to the viewers.
    fn stand(own: DMat3, up: Given, front: Given, right: Given) -> [DVec3; 3] {
        let turn = VolumeAxes::new(up, front, right).unwrap().display_from_volume(own);
        [turn.row(0), turn.row(1), turn.row(2)]
    }

    #[track_caller]
    fn assert_stands(found: [DVec3; 3], expected: [VolumeAxis; 3]) {
        assert_eq!(found, expected.map(VolumeAxis::direction));
    }

    #[test]
    fn up_and_front_go_where_they_say() {
        for own in [DMat3::IDENTITY, PATIENT] {
            assert_stands(stand(own, Some(PlusZ), Some(MinusY), None), [PlusX, PlusZ, MinusY]);
            assert_stands(stand(own, Some(MinusX), Some(PlusY), None), [MinusZ, MinusX, PlusY]);
        }
    }

    #[test]
    fn what_is_not_given_is_as_the_volume_says() {
        let identity = DMat3::IDENTITY;
        assert_stands(stand(PATIENT, Some(PlusZ), None, None), [PlusX, PlusZ, MinusY]);
        assert_stands(stand(PATIENT, None, Some(MinusY), None), [PlusX, PlusZ, MinusY]);
        // Upside down, a patient still faces the viewers.
        assert_stands(stand(PATIENT, Some(MinusZ), None, None), [MinusX, MinusZ, MinusY]);
        // The front is up, so something else must face the viewers: the right stays.
        assert_stands(stand(PATIENT, Some(MinusY), None, None), [PlusX, MinusY, MinusZ]);
        assert_stands(stand(identity, Some(MinusZ), None, None), [PlusX, MinusZ, PlusY]);
        assert_stands(stand(identity, None, None, Some(PlusY)), [PlusY, MinusX, PlusZ]);
    }

    #[test]
    fn a_mirrored_volume_stays_the_right_way_round() {
        // Slices from the head down.
        let downward = PATIENT * DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        assert_stands(stand(downward, Some(MinusZ), Some(MinusY), None), [PlusX, MinusZ, MinusY]);
        assert_stands(stand(downward, Some(MinusZ), None, None), [PlusX, MinusZ, MinusY]);
    }

    #[test]
    fn a_given_right_may_mirror_but_not_collapse() {
        let mirrored = VolumeAxes::new(Some(PlusZ), Some(PlusY), Some(PlusX)).unwrap();
        assert_eq!(mirrored.display_from_volume(PATIENT).determinant(), -1.0);
        assert_eq!(VolumeAxes::new(Some(PlusZ), Some(MinusZ), None), None);
        assert_eq!(VolumeAxes::new(Some(PlusZ), Some(PlusY), Some(MinusY)), None);
        assert_eq!(VolumeAxes::new(None, Some(PlusX), Some(PlusX)), None);
    }
}
