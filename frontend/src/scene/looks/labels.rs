//! The look of a segmentation.

use super::Values;
use super::draft::{Draft, Per, Points};
use optics::Light;

/// Optical depth of a region as long as the volume: so little that a voxel is not yet solid, since a region's own colour must
/// outweigh the other labels that shine up at its border.
const DEPTH: f64 = 40.0;
/// A value belongs to a label that is this near, in parts of the way to the next one: between two regions, all labels that lie
/// between theirs in number would shine up.
const NEAR: f64 = 0.15;
/// Parts of the circle of hues between a label and the next: the golden ratio, so that neighbours in number differ.
const TURN: f64 = 0.618_033_988_749_895;

/// Each label in its own colour; the commonest one, which is the background, is not shown. Where values are no labels, equal
/// parts of their range stand for them.
pub(super) fn labels(values: &Values) -> Draft {
    let histogram = &values.histogram;
    let parts = || (0..=8).map(|part| (histogram.low + f64::from(part) / 8.0 * histogram.width()) as f32);
    let labels = values.labels.clone().unwrap_or_else(|| parts().collect());
    let hidden = nearest(&labels, histogram.background());
    let mut points = Points::new();
    for (i, &label) in labels.iter().enumerate().filter(|&(i, _)| i != hidden) {
        let gap = |other: Option<&f32>| other.map_or(1.0, |&other| f64::from((label - other).abs()));
        let before = f64::from(label) - NEAR * gap(i.checked_sub(1).and_then(|before| labels.get(before)));
        let after = f64::from(label) + NEAR * gap(labels.get(i + 1));
        let colour = hue(i as f64 * TURN);
        points.extend(
            [(before, 0.0), (before, DEPTH), (after, DEPTH), (after, 0.0)].map(|(v, d)| (v, d, colour)),
        );
    }
    if points.is_empty() {
        points.push((histogram.background(), 0.0, hue(0.0)));
    }
    let ends = labels.first().zip(labels.last()).map(|(&a, &b)| (f64::from(a), f64::from(b)));
    let light = Light { ambient: 0.35, diffuse: 0.75, gradient_half: 0.01, ..Light::default() };
    Draft { points, per: Per::Volume, domain: ends, light: Some(light) }
}

fn nearest(labels: &[f32], value: f64) -> usize {
    let distance = |label: f32| (f64::from(label) - value).abs();
    let places = 0..labels.len();
    places.min_by(|&a, &b| distance(labels[a]).total_cmp(&distance(labels[b]))).unwrap_or(0)
}

/// A colour of the circle, linear.
fn hue(turns: f64) -> [f64; 3] {
    let channel = |shift: f64| {
        let around = (turns + shift).rem_euclid(1.0);
        let triangle = (6.0 * (around - 0.5).abs() - 1.0).clamp(0.0, 1.0);
        (0.15 + 0.8 * triangle).powf(2.2)
    };
    [channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)]
}
