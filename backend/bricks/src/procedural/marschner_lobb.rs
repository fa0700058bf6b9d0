//! The test signal of Marschner and Lobb, "An evaluation of reconstruction filters for volume rendering" (1994).

use super::Field;
use super::interval::{Interval, distance_to_origin};
use glam::DVec3;
use std::f64::consts::PI;

/// Frequency of the ripples, and their height, as in the paper.
const FREQUENCY: f64 = 6.0;
const HEIGHT: f64 = 0.25;

/// ρ(x, y, z) = (1 − sin(πz/2) + α (1 + cos(2π f cos(πr/2)))) / (2 (1 + α)) with r = |(x, y)| over [−1, 1]³.
pub struct MarschnerLobb {
    centre: DVec3,
}

impl MarschnerLobb {
    /// The signal with its origin in the middle of the extent.
    pub fn new(extent: DVec3) -> Self {
        Self { centre: extent / 2.0 }
    }

    /// The paper's coordinates: two units along the largest axis.
    fn signal_point(&self, position: DVec3) -> DVec3 {
        (position - self.centre) * 2.0
    }
}

impl Field for MarschnerLobb {
    fn value(&self, position: DVec3) -> f64 {
        let q = self.signal_point(position);
        let ripple = (2.0 * PI * FREQUENCY * (PI / 2.0 * q.x.hypot(q.y)).cos()).cos();
        (1.0 - (PI / 2.0 * q.z).sin() + HEIGHT * (1.0 + ripple)) / (2.0 * (1.0 + HEIGHT))
    }

    fn gradient(&self, position: DVec3) -> DVec3 {
        let q = self.signal_point(position);
        let r = q.x.hypot(q.y);
        let angle = PI / 2.0 * r;
        let by_r = (2.0 * PI * FREQUENCY * angle.cos()).sin() * PI * PI * FREQUENCY * angle.sin();
        // On the axis the ripple is flat: sin(angle) / r tends to π/2, and r · that to 0.
        let around = if r > 0.0 { HEIGHT * by_r / r } else { 0.0 };
        let along = -(PI / 2.0) * (PI / 2.0 * q.z).cos();
        DVec3::new(around * q.x, around * q.y, along) / (1.0 + HEIGHT)
    }

    fn range_in_box(&self, low: DVec3, high: DVec3) -> (f64, f64) {
        let (low, high) = (self.signal_point(low), self.signal_point(high));
        let radius = distance_to_origin(low.with_z(0.0), high.with_z(0.0));
        let ripple = radius.scaled(PI / 2.0).cos().scaled(2.0 * PI * FREQUENCY).cos();
        let slope = Interval::new(low.z, high.z).scaled(PI / 2.0).sin().scaled(-1.0);
        let sum = slope.plus(ripple.scaled(HEIGHT)).plus(Interval::new(1.0 + HEIGHT, 1.0 + HEIGHT));
        sum.scaled(0.5 / (1.0 + HEIGHT)).monotone(|value| value).unit()
    }
}
