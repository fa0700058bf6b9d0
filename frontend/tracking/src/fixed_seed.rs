//! One seed for every property test, so that a failure is the same failure everywhere.

use proptest::test_runner::{Config, RngSeed};

/// The seed.
const SEED: u64 = 60;

/// The configuration of the property tests of this crate. A failing case is printed, smallest first.
pub(crate) fn config() -> Config {
    Config { rng_seed: RngSeed::Fixed(SEED), failure_persistence: None, ..Config::default() }
}
