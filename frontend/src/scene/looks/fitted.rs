//! Looks that are fitted to the histogram.

use super::Values;
use super::draft::{Draft, Per, Points};
use optics::Light;

/// A light that responds to the edges that the volume has, whose domain is `width` wide.
fn light_for(values: &Values, width: f64) -> Light {
    let half = if width > 0.0 { 0.4 * values.slope / width } else { 0.02 };
    Light { ambient: 0.3, diffuse: 0.8, gradient_half: half.clamp(1e-4, 0.05), ..Light::default() }
}

fn draft(values: &Values, points: Points, domain: (f64, f64), is_lit: bool) -> Draft {
    let light = is_lit.then(|| light_for(values, domain.1 - domain.0));
    Draft { points, per: Per::Volume, domain: Some(domain), light }
}

/// Solid from where background turns into tissue; brighter tissue is paler.
pub(super) fn mr(values: &Values) -> Draft {
    let histogram = &values.histogram;
    let (low, threshold) = (histogram.background(), histogram.threshold());
    let surface = |part: f64| low + part * (threshold - low);
    let tissue = |part: f64| threshold + part * (histogram.high - threshold);
    let points = vec![
        (surface(0.55), 0.0, [0.45, 0.25, 0.18]),
        (surface(1.0), 150.0, [0.72, 0.46, 0.36]),
        (tissue(0.2), 300.0, [0.83, 0.62, 0.52]),
        (tissue(0.5), 500.0, [0.90, 0.76, 0.68]),
        (tissue(1.0), 600.0, [1.0, 0.95, 0.90]),
    ];
    draft(values, points, (low.min(histogram.low), histogram.high), true)
}

/// Light that adds up, as under the microscope.
pub(super) fn fluorescence(values: &Values) -> Draft {
    let histogram = &values.histogram;
    let low = histogram.background();
    let above = |part: f64| low + part * (histogram.high - low);
    let points = vec![
        (above(0.06), 0.0, [0.01, 0.12, 0.06]),
        (above(0.2), 12.0, [0.02, 0.30, 0.12]),
        (above(0.5), 70.0, [0.06, 0.65, 0.22]),
        (above(0.8), 220.0, [0.35, 0.95, 0.40]),
        (above(1.0), 400.0, [0.90, 1.0, 0.75]),
    ];
    draft(values, points, (low, histogram.high), true)
}

/// What is farther from the middle than the noise, on the side that reaches farther: stain is dark, but many tomograms are
/// inverted.
pub(super) fn tomogram(values: &Values) -> Draft {
    let [lowest, low, middle, high, highest] = [0.002, 0.16, 0.5, 0.84, 0.998].map(|q| values.quantile(q));
    let noise = 0.5 * (high - low);
    let is_dark = middle - lowest >= highest - middle;
    let away = if is_dark { -noise } else { noise };
    let mut points = vec![
        (middle + 1.6 * away, 0.0, [0.35, 0.22, 0.12]),
        (middle + 2.2 * away, 40.0, [0.75, 0.52, 0.30]),
        (middle + 3.0 * away, 250.0, [0.92, 0.76, 0.52]),
        (middle + 4.5 * away, 600.0, [1.0, 0.95, 0.85]),
    ];
    if is_dark {
        points.reverse();
    }
    draft(values, points, (middle - 6.0 * noise, middle + 6.0 * noise), true)
}

/// Nothing where most voxels are, then a cool veil, then warm and solid toward the end that lies farther off.
pub(super) fn scalar(values: &Values) -> Draft {
    let histogram = &values.histogram;
    let background = histogram.background();
    let is_upward = histogram.place(background) <= 0.66;
    let (near, far) = if is_upward {
        (background + 0.04 * histogram.width(), histogram.high)
    } else {
        (background - 0.04 * histogram.width(), histogram.low)
    };
    let (from, all) = match is_upward {
        true => (values.share(f64::NEG_INFINITY, near), 1.0),
        false => (values.share(f64::NEG_INFINITY, near), 0.0),
    };
    let at = |part: f64| match part < 1.0 {
        true => values.quantile(from + part * (all - from)).clamp(near.min(far), near.max(far)),
        false => far,
    };
    let mut points = vec![
        (at(0.3), 0.0, [0.03, 0.20, 0.55]),
        (at(0.5), 5.0, [0.06, 0.40, 0.62]),
        (at(0.7), 12.0, [0.25, 0.55, 0.55]),
        (at(0.85), 50.0, [0.85, 0.55, 0.28]),
        (at(0.95), 200.0, [0.95, 0.75, 0.50]),
        (at(1.0), 500.0, [1.0, 0.95, 0.88]),
    ];
    if !is_upward {
        points.reverse();
    }
    draft(values, points, (histogram.low, histogram.high), true)
}
