//! Where a volume and its viewer are, and how closely it is followed, at random.

use super::look::directions;
use glam::{DAffine3, DMat3, DQuat, DVec3, UVec3};
use optics::Quality;
use proptest::prelude::*;

/// Where the volume and its viewer are.
#[derive(Clone, Debug, PartialEq)]
pub struct Stand {
    /// Its longest edge, metres.
    pub longest_m: f64,
    /// Its centre, display frame, metres.
    pub centre_in_display: DVec3,
    /// How it is turned.
    pub rotation: DQuat,
    /// Lengths of a voxel's edges as shares of each other, negative where it is mirrored.
    pub spacing: DVec3,
    /// The virtual observer.
    pub observer_in_display: DVec3,
    /// η.
    pub eta: f64,
}

impl Stand {
    /// Volume frame to display frame for a volume of `dims` voxels.
    pub fn place(&self, dims: UVec3) -> DAffine3 {
        let dims = dims.as_dvec3();
        let scale = self.longest_m / (dims * self.spacing.abs()).max_element();
        let linear = DMat3::from_quat(self.rotation) * DMat3::from_diagonal(self.spacing * scale);
        DAffine3 { matrix3: linear, translation: self.centre_in_display - linear * (0.5 * dims) }
    }
}

/// Most volumes at the screen, some around the viewer, some upright before a viewer who looks along an axis.
pub(super) fn stands() -> impl Strategy<Value = Stand> {
    let eta = prop_oneof![1 => Just(0.0), 1 => Just(0.5), 2 => Just(1.0), 1 => 0.0..=1.0];
    let observer = prop_oneof![
        1 => Just(DVec3::new(0.0, 0.0, 1.2)),
        1 => (-0.1..0.1, -0.1..0.1, 0.6..2.0).prop_map(DVec3::from),
    ];
    let is_around_viewer = prop::bool::weighted(0.15);
    let small = || -0.1..0.1;
    (eta, observer, is_around_viewer, 0.12..0.5, (small(), small(), small()), rotations(), spacings())
        .prop_map(|(eta, observer, is_around_viewer, size_m, shift, rotation, spacing)| {
            let shift = DVec3::from(shift);
            let (longest_m, centre) =
                if is_around_viewer { (6.0 * size_m, observer + shift) } else { (size_m, shift) };
            Stand {
                longest_m,
                centre_in_display: centre,
                rotation,
                spacing,
                observer_in_display: observer,
                eta,
            }
        })
}

/// None, a quarter turn about an axis, or any.
fn rotations() -> impl Strategy<Value = DQuat> {
    let quarter = |axis: DVec3| Just(DQuat::from_axis_angle(axis, std::f64::consts::FRAC_PI_2));
    let any = (directions(), 0.0..6.3).prop_map(|(axis, turn)| DQuat::from_axis_angle(axis, turn));
    prop_oneof![2 => Just(DQuat::IDENTITY), 1 => quarter(DVec3::X), 1 => quarter(DVec3::Y), 6 => any]
}

fn spacings() -> impl Strategy<Value = DVec3> {
    let edge = || 0.4..2.5;
    let some = (edge(), edge(), edge()).prop_map(DVec3::from);
    let sign = prop_oneof![3 => Just(1.0), 1 => Just(-1.0)];
    (prop_oneof![Just(DVec3::ONE), some], sign)
        .prop_map(|(spacing, sign)| DVec3::new(spacing.x * sign, spacing.y, spacing.z))
}

/// The default, better, worse; the finest level, several, and those beyond.
pub(super) fn qualities(has_quadrilinear: bool) -> impl Strategy<Value = Quality> {
    let default = Quality::default();
    let better = (0.1..0.4, -5.5..-4.0f64, 0.0..1e-3);
    let worse = (0.4..3.0, -4.0..-1.0f64, 0.0..0.05);
    let number = move |(step_voxels, exponent, termination)| Quality {
        step_voxels,
        tolerance: 10f64.powf(exponent),
        termination,
        ..default
    };
    let closeness =
        prop_oneof![10 => Just(default), 2 => better.prop_map(number), 1 => worse.prop_map(number)];
    let lod_scale = prop_oneof![2 => Just(0.0), 1 => Just(1.0), 3 => 1.0..16.0];
    (closeness, lod_scale, prop::bool::ANY).prop_map(move |(closeness, lod_scale, quadrilinear)| Quality {
        lod_scale,
        quadrilinear: quadrilinear && has_quadrilinear,
        ..closeness
    })
}
