//! Random numbers, the same in every run.

use glam::DVec3;
use std::f64::consts::TAU;

/// A generator (SplitMix64, Steele, Lea and Flood 2014).
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1, without 0.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((bits ^ (bits >> 31)) >> 11) as f64 + 1.0) / (1_u64 << 53) as f64
    }

    /// Between two limits.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Normally distributed along each axis, of unit variance (Box and Muller 1958).
    pub fn vector(&mut self) -> DVec3 {
        let mut normal = || (-2.0 * self.uniform().ln()).sqrt() * (TAU * self.uniform()).cos();
        DVec3::new(normal(), normal(), normal())
    }
}
