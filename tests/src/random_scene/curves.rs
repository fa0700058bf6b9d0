//! Transfer functions at random: with spikes from a hundredth of a table cell to two cells wide, jumps, flat parts and ranges of many decades.

use super::sometimes;
use glam::DVec3;
use needs::tables::TABLE_CELLS;
use optics::Curve;
use proptest::prelude::*;

/// A table cell.
const CELL: f64 = 1.0 / TABLE_CELLS as f64;

/// An extinction.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Control points of values from 0 to 1.
    points: Vec<(f64, f64)>,
    has_jump: bool,
    spike: Option<Spike>,
    /// What 1 stands for, per voxel.
    most: f64,
}

/// A narrow range of scalars that is denser than the rest.
#[derive(Clone, Copy, Debug)]
struct Spike {
    /// Where it is densest.
    peak: f64,
    half_width: f64,
    /// Times the largest value elsewhere.
    height: f64,
}

/// Colours.
#[derive(Clone, Debug)]
pub(super) struct Colours {
    pub(super) curve: Curve<DVec3>,
    pub(super) is_even: bool,
}

/// Extinctions of 1e-6 to 1e6 per voxel, most of them such as pictures have; few so thin that they show nothing.
pub(super) fn shapes() -> impl Strategy<Value = Shape> {
    let exponent = prop_oneof![7 => -1.7..0.3, 3 => -1.0..6.0, 1 => -6.0..-1.7];
    let spike = (0.005..0.995, -2.0..0.3, 0.0..3.0).prop_map(|(peak, cells, decades): (f64, f64, f64)| {
        Spike { peak, half_width: 10f64.powf(cells) * CELL, height: 10f64.powf(decades) }
    });
    let spike = sometimes(0.15, spike);
    (points(0.3), exponent, spike).prop_map(|((points, has_jump), exponent, spike)| Shape {
        points: reaching_one(points),
        has_jump,
        spike,
        most: 10f64.powf(exponent),
    })
}

/// The same points, the highest of them at 1.
fn reaching_one(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let most = points.iter().map(|p| p.1).fold(0.0, f64::max);
    if most > 0.0 {
        points.iter_mut().for_each(|p| p.1 /= most);
    } else {
        let middle = points.len() / 2;
        points[middle].1 = 1.0;
    }
    points
}

/// Rising positions with values from 0 to 1, of which some are 0; perhaps with a jump.
pub(super) fn points(jump: f64) -> impl Strategy<Value = (Vec<(f64, f64)>, bool)> {
    let value = || prop_oneof![1 => Just(0.0), 3 => 0.0..=1.0];
    let gaps = prop::collection::vec((0.04..1.0, value()), 2..7);
    let jump = sometimes(jump, (any::<prop::sample::Index>(), value()));
    (gaps, jump).prop_map(|(gaps, jump)| {
        let total: f64 = gaps.iter().map(|g| g.0).sum::<f64>() + 0.2;
        let mut at = 0.0;
        let place = |(gap, value): (f64, f64)| {
            at += gap / total;
            (at, value)
        };
        let mut points: Vec<(f64, f64)> = gaps.into_iter().map(place).collect();
        if let Some((index, value)) = &jump {
            let index = index.index(points.len());
            points.insert(index + 1, (points[index].0, *value));
        }
        (points, jump.is_some())
    })
}

/// Colours, some of them brighter than a screen.
pub(super) fn colours() -> impl Strategy<Value = Colours> {
    let colour = || [0.0..=1.0, 0.0..=1.0, 0.0..=1.0].prop_map(|rgb: [f64; 3]| DVec3::from(rgb));
    let colours = prop::collection::vec(colour(), 8);
    let brightness = prop_oneof![9 => Just(1.0), 1 => 1.0..4.0];
    (points(0.1), colours, brightness).prop_map(|((points, has_jump), colours, brightness)| {
        let points = points.iter().zip(colours).map(|(p, colour)| (p.0, colour * brightness)).collect();
        Colours { curve: curve(points), is_even: !has_jump }
    })
}

/// A curve from points that are in order.
pub(super) fn curve<V: optics::CurveValue>(points: Vec<(f64, V)>) -> Curve<V> {
    Curve::new(points).expect("rising positions and values from 0 make a curve")
}

impl Shape {
    /// The curve, with numbers `per_unit` times those per voxel.
    pub(super) fn curve(&self, per_unit: f64) -> Curve<f64> {
        let plain = curve(self.points.iter().map(|&(s, value)| (s, value * self.most * per_unit)).collect());
        let Some(Spike { peak, half_width, height }) = self.spike else { return plain };
        let (low, high) = (peak - half_width, peak + half_width);
        let outside = |p: &&(f64, f64)| p.0 < low || p.0 > high;
        let mut points: Vec<(f64, f64)> = plain.points().iter().filter(outside).copied().collect();
        let spike = [(low, plain.at(low)), (peak, height * self.most * per_unit), (high, plain.at(high))];
        let at = points.partition_point(|p| p.0 < low);
        points.splice(at..at, spike);
        curve(points)
    }

    /// Its largest value per voxel.
    pub(super) fn most(&self) -> f64 {
        self.most * self.spike.map_or(1.0, |spike| spike.height)
    }

    /// Whether it has neither jump nor spike.
    pub(super) fn is_even(&self) -> bool {
        !self.has_jump && self.spike.is_none()
    }
}
