//! The rigid transform that brings points nearest to their partners, by least squares.

use super::PointPair;
use super::eigen::symmetric_eigen;
use super::spread::Spread;
use crate::rigid::RigidTransform;
use glam::{DQuat, DVec3};

/// Rotation, translation, and how well they fit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fit {
    pub display_from_tracker: RigidTransform,
    /// RMS of the distances that are left, metres.
    pub rms_m: f64,
    /// The same for the best transform that mirrors, metres.
    pub mirrored_rms_m: f64,
    count: f64,
    spread_in_display: Spread,
}

impl Fit {
    /// Of at least three pairs that do not lie on a line.
    ///
    /// The rotation is the quaternion of Horn 1987, "Closed-form solution of absolute orientation using unit quaternions",
    /// section 4: the eigenvector of a matrix's largest eigenvalue. A quaternion cannot mirror, unlike the orthogonal
    /// matrix of a singular value decomposition, which must be guarded against it.
    pub fn of(pairs: &[&PointPair]) -> Self {
        let in_tracker = Spread::of(pairs.iter().map(|pair| pair.point_in_tracker));
        let in_display = Spread::of(pairs.iter().map(|pair| pair.point_in_display));
        let offsets = pairs.iter().map(|pair| {
            (pair.point_in_tracker - in_tracker.centroid_m, pair.point_in_display - in_display.centroid_m)
        });
        let matrix = horn_matrix(offsets.clone());
        let [(_, [w, x, y, z]), .., (smallest, _)] = symmetric_eigen(matrix);
        let rotation = DQuat::from_xyzw(x, y, z, w).normalize();
        let translation_m = in_display.centroid_m - rotation * in_tracker.centroid_m;
        let display_from_tracker = RigidTransform { rotation, translation_m };
        let count = pairs.len() as f64;
        let squares: f64 =
            pairs.iter().map(|pair| residual(&display_from_tracker, pair).length_squared()).sum();
        // The best improper rotation is the inversion after the rotation of the smallest eigenvalue.
        let sizes: f64 = offsets.map(|(a, b)| a.length_squared() + b.length_squared()).sum();
        let mirrored_squares = (sizes + 2.0 * smallest).max(0.0);
        Self {
            display_from_tracker,
            rms_m: (squares / count).sqrt(),
            mirrored_rms_m: (mirrored_squares / count).sqrt(),
            count,
            spread_in_display: in_display,
        }
    }

    /// How far a pair's points are apart after the transform, metres.
    pub fn distance_m(&self, pair: &PointPair) -> f64 {
        residual(&self.display_from_tracker, pair).length()
    }

    /// RMS error of a measured point, estimated from the residuals, metres. A fit takes up six of their degrees of freedom.
    pub fn point_error_m(&self) -> f64 {
        self.rms_m * (self.count / (self.count - 2.0)).sqrt()
    }

    /// RMS error of the transform at a point of the display frame, as a factor of that of a measured point: Fitzpatrick,
    /// West and Maurer 1998, "Predicting error in rigid-body point-based registration", equation 46.
    pub fn gain_at(&self, point_in_display: DVec3) -> f64 {
        let leverage = self.spread_in_display.leverage(point_in_display);
        ((1.0 + leverage / 3.0) / self.count).sqrt()
    }
}

fn residual(display_from_tracker: &RigidTransform, pair: &PointPair) -> DVec3 {
    pair.point_in_display - display_from_tracker.point(pair.point_in_tracker)
}

/// Horn's matrix N of pairs of offsets from the centroids, whose eigenvectors are quaternions w, x, y, z.
fn horn_matrix(offsets: impl Iterator<Item = (DVec3, DVec3)>) -> [[f64; 4]; 4] {
    let mut sums = [[0.0; 3]; 3];
    for (from, to) in offsets {
        for (row, a) in sums.iter_mut().zip(from.to_array()) {
            row.iter_mut().zip(to.to_array()).for_each(|(sum, b)| *sum += a * b);
        }
    }
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = sums;
    [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ]
}
