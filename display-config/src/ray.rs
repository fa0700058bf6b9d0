//! The ray of a projector pixel.

use crate::{Clip, RayError};
use glam::{DVec2, DVec3};

/// A ray in the display frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// O: where it starts, on the line y = Vy, z = Vz; metres.
    pub origin_in_display: DVec3,
    /// The unit direction from O through the screen point.
    pub direction_in_display: DVec3,
}

impl Ray {
    /// The point `distance_m` along it.
    pub fn at(&self, distance_m: f64) -> DVec3 {
        self.origin_in_display + distance_m * self.direction_in_display
    }
}

/// The law of one projector's rays, for one observer and one η (LFD eq. 1): a screen point S is seen from
/// O = (A + B Sx, Vy, Vz), with k = (Vz − Ez) / (0 − Ez), A = (1 − η) Vx + η Ex (1 − k) and B = η k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamLaw {
    a: f64,
    b: f64,
    observer_y: f64,
    observer_z: f64,
}

/// A denominator smaller than its terms by this factor is only their rounding, and counts as zero.
const ZERO: f64 = 4.0 * f64::EPSILON;

impl BeamLaw {
    /// The law for projector centre E, observer V (both in metres, display frame) and η in [0, 1].
    ///
    /// # Errors
    /// Ez = 0, Vz ≤ 0, η outside [0, 1], non-finite numbers, or numbers so extreme that A or B overflows.
    pub fn new(projector_centre: DVec3, observer: DVec3, eta: f64) -> Result<Self, RayError> {
        if !projector_centre.is_finite() || !observer.is_finite() || !eta.is_finite() {
            return Err(RayError::NotFinite);
        }
        if projector_centre.z == 0.0 {
            return Err(RayError::ProjectorInScreenPlane);
        }
        if observer.z <= 0.0 {
            return Err(RayError::ObserverBehindScreen { z_m: observer.z });
        }
        if !(0.0..=1.0).contains(&eta) {
            return Err(RayError::EtaOutOfRange { eta });
        }
        let k = (observer.z - projector_centre.z) / -projector_centre.z;
        let a = (1.0 - eta) * observer.x + eta * projector_centre.x * (1.0 - k);
        let b = eta * k;
        if !a.is_finite() || !b.is_finite() {
            return Err(RayError::NotFinite);
        }
        Ok(Self { a, b, observer_y: observer.y, observer_z: observer.z })
    }

    /// A, metres: Ox = A + B Sx.
    pub fn a(&self) -> f64 {
        self.a
    }

    /// B, a pure number: Ox = A + B Sx.
    pub fn b(&self) -> f64 {
        self.b
    }

    /// What a length at a depth is divided by where it lands on the screen: across, B (1 − m) + m, and up, m. Linear in z; a
    /// depth at which either is not positive has no upright image.
    pub fn divisors(&self, z_m: f64) -> DVec2 {
        let toward_observer = z_m / self.observer_z;
        DVec2::new(1.0 + (self.b - 1.0) * toward_observer, 1.0 - toward_observer)
    }

    /// O: where the ray through a screen point starts.
    pub fn origin(&self, screen: DVec2) -> DVec3 {
        DVec3::new(self.a + self.b * screen.x, self.observer_y, self.observer_z)
    }

    /// The ray through a screen point: O + t · normalize(S − O). Straight for every η.
    pub fn ray(&self, screen: DVec2) -> Ray {
        let origin = self.origin(screen);
        // S and O differ by Vz > 0 in z at least, so the difference has a length.
        Ray { origin_in_display: origin, direction_in_display: (screen.extend(0.0) - origin).normalize() }
    }

    /// Where a point lands on the screen: the S whose ray (extended both ways below the observer's plane) passes
    /// through it. With m = (Vz − Qz) / Vz: Sx = (Qx − A (1 − m)) / (B (1 − m) + m), Sy = Vy + (Qy − Vy) / m.
    ///
    /// # Errors
    /// A point at or behind the observer's plane, a point through which no single ray passes, non-finite numbers.
    pub fn screen_from_point(&self, point: DVec3) -> Result<DVec2, Clip> {
        if !point.is_finite() {
            return Err(Clip::NotFinite);
        }
        let m = (self.observer_z - point.z) / self.observer_z;
        if m <= 0.0 {
            return Err(Clip::BehindObserver);
        }
        // 1 − m as the quotient it is: subtracting would lose the digits of small depths.
        let toward_observer = point.z / self.observer_z;
        let spread = self.b * toward_observer;
        let denominator = spread + m;
        if denominator.abs() <= ZERO * (spread.abs() + m) {
            return Err(Clip::NoImage);
        }
        let x = (point.x - self.a * toward_observer) / denominator;
        let y = self.observer_y + (point.y - self.observer_y) / m;
        let screen = DVec2::new(x, y);
        if screen.is_finite() { Ok(screen) } else { Err(Clip::NoImage) }
    }
}

#[cfg(test)]
#[path = "ray_tests.rs"]
mod tests;
