//! A clip plane, seen along one ray.

use super::Zone;
use crate::Ray;
use glam::DVec3;
use optics::{ClipPlane, CurveValue};

/// The law of [`ClipPlane`] for one direction of view.
#[derive(Clone, Copy, Debug)]
pub struct Clip {
    plane: ClipPlane,
    /// Factor of the extinction of what is cut away: lerp(1, μ, strength).
    context: f64,
    /// δ from which on the boost holds the factor of the extinction.
    boosted_from: f64,
}

impl Clip {
    /// For a ray that left the eye along `view`.
    pub fn new(plane: ClipPlane, view: DVec3) -> Self {
        let facing = (-plane.normal_in_display.dot(view)).max(0.0);
        let context = 1.0.lerp(plane.context.at(1.0 - facing), plane.strength);
        let mut clip = Self { plane, context, boosted_from: 0.0 };
        clip.boosted_from = clip.first_boosted();
        clip
    }

    /// The t at which a straight path crosses the plane, the back of the sliced tissue, and where the boost is reached.
    pub fn breaks(&self, way: &Ray) -> [f64; 3] {
        let start = self.distance(way.origin_in_display);
        let speed = self.plane.normal_in_display.dot(way.direction_in_display);
        [0.0, -self.plane.thickness_m, self.boosted_from].map(|distance| (distance - start) / speed)
    }

    /// Which part of the law holds at a point.
    pub fn zone(&self, point: DVec3) -> Zone {
        let distance = self.distance(point);
        if self.plane.strength == 0.0 || distance <= -self.plane.thickness_m {
            Zone::Idle
        } else if distance > 0.0 {
            Zone::Before
        } else {
            Zone::Behind
        }
    }

    /// Factors of the extinction and of the shading weight.
    pub fn factors(&self, zone: Zone, point: DVec3) -> (f64, f64) {
        match zone {
            Zone::Idle => (1.0, 1.0),
            Zone::Before => (self.context, 1.0),
            Zone::Behind | Zone::Everywhere => {
                let u = self.plane.strength * self.nearness(point);
                (self.factor(self.distance(point)).min(self.plane.boost), 1.0 - u)
            }
        }
    }

    /// Factor of the extinction at a distance behind the plane, not held to the boost.
    fn factor(&self, distance: f64) -> f64 {
        let y = 1.0 - self.plane.strength * (1.0 + distance / self.plane.thickness_m);
        y.powi(-2) - 2.0 * (1.0 - y)
    }

    /// Where the factor, which rises toward the plane, reaches the boost; on the plane if it does nowhere.
    fn first_boosted(&self) -> f64 {
        let is_boosted = |share: f64| self.factor(-share * self.plane.thickness_m) >= self.plane.boost;
        let (mut boosted, mut free) = (0.0, 1.0);
        while free - boosted > f64::EPSILON {
            let middle = 0.5 * (boosted + free);
            *(if is_boosted(middle) { &mut boosted } else { &mut free }) = middle;
        }
        -boosted * self.plane.thickness_m
    }

    /// smoothstep(δ, −thickness, 0).
    fn nearness(&self, point: DVec3) -> f64 {
        let t = (1.0 + self.distance(point) / self.plane.thickness_m).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }

    fn distance(&self, point: DVec3) -> f64 {
        self.plane.normal_in_display.dot(point - self.plane.point_in_display)
    }
}
