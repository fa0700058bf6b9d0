//! How points lie about their centroid.

use super::eigen::symmetric_eigen;
use glam::DVec3;

/// The centroid of some points and their principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spread {
    pub centroid_m: DVec3,
    /// Unit vectors, along the largest variance first.
    axes: [DVec3; 3],
    /// Mean squared distance from the centroid along each axis, square metres.
    variances_m2: [f64; 3],
}

impl Spread {
    /// Of at least one point.
    pub fn of(points: impl ExactSizeIterator<Item = DVec3> + Clone) -> Self {
        let count = points.len() as f64;
        let centroid_m = points.clone().sum::<DVec3>() / count;
        let mut scatter = [[0.0; 3]; 3];
        for offset in points.map(|point| (point - centroid_m).to_array()) {
            for (i, row) in scatter.iter_mut().enumerate() {
                (0..3).for_each(|j| row[j] += offset[i] * offset[j] / count);
            }
        }
        let parts = symmetric_eigen(scatter);
        let variances_m2 = parts.map(|(variance, _)| variance.max(0.0));
        Self { centroid_m, axes: parts.map(|(_, axis)| DVec3::from_array(axis)), variances_m2 }
    }

    /// Standard deviation along the longest axis, metres.
    pub fn length_m(&self) -> f64 {
        self.variances_m2[0].sqrt()
    }

    /// Standard deviation along the second axis, metres: 0 for points on a line.
    pub fn width_m(&self) -> f64 {
        self.variances_m2[1].sqrt()
    }

    /// Σ dₖ² / fₖ² over the principal axes k, where d is the distance of a point from an axis, and f the RMS distance of
    /// the points that were spread. Infinite for points on a line.
    pub fn leverage(&self, point_m: DVec3) -> f64 {
        let offset = point_m - self.centroid_m;
        let along: [f64; 3] = self.axes.map(|axis| offset.dot(axis).powi(2));
        let ratio = |axis: usize| {
            let about = |squares: &[f64; 3]| squares[(axis + 1) % 3] + squares[(axis + 2) % 3];
            match about(&along) {
                0.0 => 0.0,
                distance => distance / about(&self.variances_m2),
            }
        };
        (0..3).map(ratio).sum()
    }
}
