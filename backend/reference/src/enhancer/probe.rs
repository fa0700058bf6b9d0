//! A context-preserving probe, seen along one ray.

use super::{Place, Zone};
use crate::Ray;
use glam::DVec3;
use optics::{CurveValue, Probe};

/// The law of [`Probe`] for one direction of view.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    probe: Probe,
    /// The direction of view, with which it compares gradients.
    pub view: DVec3,
    /// ω_a: how much the ray looks along the tool.
    facing: f64,
}

impl Sphere {
    /// For a ray that left the eye along `view`.
    pub fn new(probe: Probe, view: DVec3) -> Self {
        let facing = probe.facing.at(probe.axis_in_display.dot(view).max(0.0));
        Self { probe, view, facing }
    }

    /// The t at which a straight path enters the sphere, leaves it, and passes q = 0; those there are.
    pub fn breaks(&self, way: &Ray) -> [f64; 3] {
        let from_centre = way.origin_in_display - self.probe.centre_in_display;
        let nearest = -from_centre.dot(way.direction_in_display);
        let miss = (from_centre + nearest * way.direction_in_display).length();
        // Factored, so that a grazing way keeps its digits.
        let half = ((self.probe.radius_m - miss) * (self.probe.radius_m + miss)).sqrt();
        let middle = -from_centre.dot(self.view) / way.direction_in_display.dot(self.view);
        [nearest - half, nearest + half, middle]
    }

    /// Which part of the law holds at a point.
    pub fn zone(&self, point: DVec3) -> Zone {
        let from_centre = point - self.probe.centre_in_display;
        if self.probe.strength == 0.0 || from_centre.length() > self.probe.radius_m {
            Zone::Idle
        } else if from_centre.dot(self.view) < 0.0 {
            Zone::Before
        } else {
            Zone::Behind
        }
    }

    /// Factors of the extinction and of the colour for a sample of importance `importance`.
    pub fn factors(&self, zone: Zone, place: &Place, importance: f64) -> (f64, f64) {
        let eta = self.edge(place.gradient, importance);
        let q = (place.point - self.probe.centre_in_display).dot(self.view) / self.probe.radius_m;
        let depth = 1.0 - q * q;
        let (extinction, colour) = match zone {
            Zone::Idle => return (1.0, 1.0),
            Zone::Before => (0.0.lerp(eta, depth), 1.0 - eta),
            Zone::Behind | Zone::Everywhere => {
                (eta.lerp(1.0, 1.0 - depth), (1.0 - eta).lerp(1.0, 1.0 - depth))
            }
        };
        (1.0.lerp(extinction, self.probe.strength), 1.0.lerp(colour, self.probe.strength))
    }

    /// η, LFD eq. 4, with |g · v|.
    fn edge(&self, gradient: DVec3, importance: f64) -> f64 {
        let size = gradient.length();
        if !(size > 0.0 && size.is_finite()) {
            return 0.0;
        }
        let silhouette = 1.0 - (gradient.dot(self.view).abs() / size).min(1.0);
        let edges = self.probe.edges.at(importance * size / self.probe.gradient_most);
        self.facing * edges * silhouette.powi(4)
    }
}
