//! Pauses between attempts, each twice as long as the one before.

use std::time::Duration;

const SHORTEST: Duration = Duration::from_millis(100);
const LONGEST: Duration = Duration::from_secs(5);

/// The next pause.
pub(crate) struct Pause(Duration);

impl Pause {
    /// The shortest comes first.
    pub const fn new() -> Self {
        Self(SHORTEST)
    }

    /// How long to wait now.
    pub fn next(&mut self) -> Duration {
        let pause = self.0;
        self.0 = LONGEST.min(2 * pause);
        pause
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_grow_to_a_limit() {
        let mut pause = Pause::new();
        let pauses: Vec<u128> = (0..8).map(|_| pause.next().as_millis()).collect();
        assert_eq!(pauses, [100, 200, 400, 800, 1600, 3200, 5000, 5000]);
    }
}
