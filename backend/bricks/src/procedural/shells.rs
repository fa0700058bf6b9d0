//! Nested shells around the centre: ellipsoids with dents, fainter outward.

use super::Field;
use super::interval::{Interval, distance_to_origin};
use glam::DVec3;
use std::f64::consts::PI;

/// Shells from the centre to the rim.
const SHELLS: f64 = 5.0;
/// Half axes of the outermost shell without dents, as parts of the extent; the dents keep it inside the volume.
const HALF_AXES: DVec3 = DVec3::new(0.45, 0.4, 0.34);
/// Depth of the dents in units of the outermost shell, and their waves per unit in radians.
const DENT: f64 = 0.07;
const DENT_WAVE: f64 = 6.0;
/// Rounds the radius off at the centre, where it would have a kink.
const SOFT_CENTRE: f64 = 0.06;

/// With q = (p − centre) / half axes and the dented radius ρ = √(q² + c²) + d sin(wx) sin(wy) sin(wz), the value is
/// (1 − ρ²)³ · (½ − ½ cos 2π n ρ)² where |ρ| < 1, else 0.
pub struct Shells {
    centre: DVec3,
    half_axes: DVec3,
}

impl Shells {
    /// Shells that fill the extent.
    pub fn new(extent: DVec3) -> Self {
        Self { centre: extent / 2.0, half_axes: HALF_AXES * extent }
    }

    fn scaled(&self, position: DVec3) -> DVec3 {
        (position - self.centre) / self.half_axes
    }
}

fn soft_radius(distance: f64) -> f64 {
    (distance * distance + SOFT_CENTRE * SOFT_CENTRE).sqrt()
}

fn dented_radius(q: DVec3) -> f64 {
    let wave = (q * DENT_WAVE).map(f64::sin);
    soft_radius(q.length()) + DENT * wave.x * wave.y * wave.z
}

fn shell(rho: f64) -> f64 {
    0.5 - 0.5 * (2.0 * PI * SHELLS * rho).cos()
}

impl Field for Shells {
    fn value(&self, position: DVec3) -> f64 {
        let q = self.scaled(position);
        if q.length_squared() >= (1.0 + DENT) * (1.0 + DENT) {
            return 0.0;
        }
        let rho = dented_radius(q);
        let fade = (1.0 - rho * rho).max(0.0);
        fade.powi(3) * shell(rho).powi(2)
    }

    fn gradient(&self, position: DVec3) -> DVec3 {
        let q = self.scaled(position);
        let rho = dented_radius(q);
        let fade = 1.0 - rho * rho;
        if fade <= 0.0 {
            return DVec3::ZERO;
        }
        let shell_by_rho = PI * SHELLS * (2.0 * PI * SHELLS * rho).sin();
        let by_rho =
            -6.0 * rho * fade.powi(2) * shell(rho).powi(2) + fade.powi(3) * 2.0 * shell(rho) * shell_by_rho;
        let (s, c) = ((q * DENT_WAVE).map(f64::sin), (q * DENT_WAVE).map(f64::cos));
        let dents = DVec3::new(c.x * s.y * s.z, s.x * c.y * s.z, s.x * s.y * c.z) * (DENT * DENT_WAVE);
        (q / soft_radius(q.length()) + dents) * by_rho / self.half_axes
    }

    fn range_in_box(&self, low: DVec3, high: DVec3) -> (f64, f64) {
        let (low, high) = (self.scaled(low), self.scaled(high));
        let radius = distance_to_origin(low, high).monotone(soft_radius);
        let waves = [0, 1, 2].map(|axis| Interval::new(low[axis], high[axis]).scaled(DENT_WAVE).sin());
        let rho = radius.plus(waves[0].times(waves[1]).times(waves[2]).scaled(DENT));
        if rho.low >= 1.0 {
            return (0.0, 0.0);
        }
        let rho_magnitude = Interval::new(rho.low.max(0.0), rho.high.max(-rho.low));
        let fade = rho_magnitude.monotone(|rho| (1.0 - rho * rho).max(0.0).powi(3)).unit();
        let shells = rho.scaled(2.0 * PI * SHELLS).cos().monotone(|cos| (0.5 - 0.5 * cos).powi(2)).unit();
        Interval::new(fade.0 * shells.0, fade.1 * shells.1).monotone(|value| value).unit()
    }
}
