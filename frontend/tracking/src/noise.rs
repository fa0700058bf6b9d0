//! Random numbers for tests, the same in every run.

use glam::DVec3;

/// A generator (SplitMix64, Steele, Lea and Flood 2014).
pub(crate) struct Noise(pub u64);

impl Noise {
    /// From 0 to 1, without 0.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((bits ^ (bits >> 31)) >> 11) as f64 + 1.0) / (1_u64 << 53) as f64
    }

    /// Normally distributed, of unit variance (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// A vector whose components are.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal())
    }
}
