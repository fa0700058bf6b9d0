//! A straight tube with round ends, soft across.

use glam::DVec3;

/// Widening of distances, which are at most of order one, for rounding.
const ROUNDING: f64 = 1e-12;

/// A tube; its weight is (1 − d²/R²)³ at distance d from its axis, and exactly 0 from R on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tube {
    pub from: DVec3,
    pub to: DVec3,
    pub radius: f64,
}

impl Tube {
    /// From the nearest point of the axis to the position.
    fn offset(&self, position: DVec3) -> DVec3 {
        let axis = self.to - self.from;
        let along = ((position - self.from).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        position - (self.from + axis * along)
    }

    fn weight_at_distance(&self, distance_squared: f64) -> f64 {
        (1.0 - distance_squared / (self.radius * self.radius)).max(0.0).powi(3)
    }

    pub fn weight(&self, position: DVec3) -> f64 {
        self.weight_at_distance(self.offset(position).length_squared())
    }

    pub fn weight_gradient(&self, position: DVec3) -> DVec3 {
        let offset = self.offset(position);
        let radius_squared = self.radius * self.radius;
        let inside = (1.0 - offset.length_squared() / radius_squared).max(0.0);
        offset * (-6.0 * inside * inside / radius_squared)
    }

    /// Bounds of the weight in a box, from the distance of its centre and its half diagonal.
    pub fn weight_range(&self, low: DVec3, high: DVec3) -> (f64, f64) {
        if !self.touches(low, high) {
            return (0.0, 0.0);
        }
        let distance = self.offset((low + high) / 2.0).length();
        let reach = (high - low).length() / 2.0 + ROUNDING;
        let nearest = (distance - reach).max(0.0);
        let farthest = distance + reach;
        (self.weight_at_distance(farthest * farthest), self.weight_at_distance(nearest * nearest))
    }

    /// Whether the tube's bounding box meets the box.
    pub fn touches(&self, low: DVec3, high: DVec3) -> bool {
        let (tube_low, tube_high) =
            (self.from.min(self.to) - self.radius, self.from.max(self.to) + self.radius);
        tube_low.cmple(high).all() && tube_high.cmpge(low).all()
    }
}
