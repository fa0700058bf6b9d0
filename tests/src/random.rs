//! Numbers at random, the same in every run.

/// A generator with a fixed seed (Knuth's MMIX numbers).
pub struct Random(pub u64);

impl Random {
    /// A number from 0 to `end` − 1.
    pub fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }
}
