//! Chains of enhancers at random, made in the unit cube and then placed in the volume.

use super::look::directions;
use glam::{DAffine3, DVec3, UVec3};
use optics::{BandPicker, ClipPlane, Enhancer, LayerOpacity, Probe, Ramp, Trapezoid};
use proptest::prelude::*;

/// Enhancers in a chain at most: what a link does with the one before it is the same in the middle of any chain.
const MOST: usize = 3;

/// Chains; empty where none are wanted. Points lie in the unit cube, lengths are shares of the volume's longest edge.
pub(super) fn chains(are_wanted: bool) -> impl Strategy<Value = Vec<Enhancer>> {
    prop::collection::vec(enhancers(), 0..=if are_wanted { MOST } else { 0 })
}

/// An enhancer of the unit cube in the volume of `dims` voxels.
pub(super) fn placed(enhancer: Enhancer, place: &DAffine3, dims: UVec3) -> Enhancer {
    let dims = dims.as_dvec3();
    let point = |p: DVec3| place.transform_point3(p * dims);
    let edges = [place.matrix3.x_axis * dims.x, place.matrix3.y_axis * dims.y, place.matrix3.z_axis * dims.z];
    let longest_m = edges.map(DVec3::length).into_iter().fold(0.0, f64::max);
    match enhancer {
        Enhancer::ClipPlane(plane) => Enhancer::ClipPlane(ClipPlane {
            point_in_display: point(plane.point_in_display),
            thickness_m: longest_m * plane.thickness_m,
            ..plane
        }),
        Enhancer::Probe(probe) => Enhancer::Probe(Probe {
            centre_in_display: point(probe.centre_in_display),
            radius_m: longest_m * probe.radius_m,
            ..probe
        }),
        Enhancer::BandPicker(_) | Enhancer::LayerOpacity(_) => enhancer,
    }
}

fn enhancers() -> impl Strategy<Value = Enhancer> {
    prop_oneof![
        planes().prop_map(Enhancer::ClipPlane),
        probes().prop_map(Enhancer::Probe),
        (bands(), directions(), facings(), strengths()).prop_map(
            |(band, axis_in_display, facing, strength)| {
                Enhancer::BandPicker(BandPicker { band, axis_in_display, facing, strength })
            }
        ),
        (bands(), directions(), facings(), 0.0..3.0, 0.0..3.0).prop_map(
            |(band, axis_in_display, facing, away, toward)| {
                Enhancer::LayerOpacity(LayerOpacity { band, axis_in_display, facing, away, toward })
            }
        ),
    ]
}

fn planes() -> impl Strategy<Value = ClipPlane> {
    let thickness = prop_oneof![1 => Just(0.0), 2 => 0.0..0.3];
    (inside(), directions(), ramps(0.0, 1.0), thickness, 0.0..4.0, strengths()).prop_map(
        |(point_in_display, normal_in_display, context, thickness_m, boost, strength)| ClipPlane {
            point_in_display,
            normal_in_display,
            context,
            thickness_m,
            // From 1 to a million.
            boost: 10f64.powf(1.5 * boost),
            strength,
        },
    )
}

fn probes() -> impl Strategy<Value = Probe> {
    (inside(), 0.05..0.6, directions(), facings(), -2.5..-0.3f64, ramps(0.0, 1.0), strengths()).prop_map(
        |(centre_in_display, radius_m, axis_in_display, facing, most, edges, strength)| Probe {
            centre_in_display,
            radius_m,
            axis_in_display,
            facing,
            gradient_most: 10f64.powf(most),
            edges,
            strength,
        },
    )
}

fn inside() -> impl Strategy<Value = DVec3> {
    [0.0..=1.0, 0.0..=1.0, 0.0..=1.0].prop_map(|p: [f64; 3]| DVec3::from(p))
}

fn strengths() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1.0), 0.0..=1.0]
}

fn facings() -> impl Strategy<Value = Ramp> {
    ramps(-1.0, 1.0)
}

/// Ramps between two numbers, at least a twentieth of their distance wide.
fn ramps(low: f64, high: f64) -> impl Strategy<Value = Ramp> {
    let span = high - low;
    (0.0..0.9, 0.05..1.0)
        .prop_map(move |(start, width)| Ramp { low: low + span * start, high: low + span * (start + width) })
}

fn bands() -> impl Strategy<Value = Trapezoid> {
    let width = || prop_oneof![1 => Just(0.0), 3 => 0.02..0.5];
    (-0.2..0.8, width(), 0.0..0.5, width()).prop_map(|(start, rise, top, fall): (f64, f64, f64, f64)| {
        let corners = [start, start + rise, start + rise + top, start + rise + top + fall];
        Trapezoid::new(corners).expect("corners that do not fall make a band")
    })
}
