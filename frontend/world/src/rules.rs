//! What visitors may do, and what time undoes.

use std::time::Duration;

/// The rules of an exhibit.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// Sizes that a volume may have, as factors of the scene's: the least and the largest.
    pub scales: (f64, f64),
    /// How far its centre may be from where the scene has it, metres.
    pub farthest_m: f64,
    /// What visitors did is undone after nobody has done anything for so long; None keeps it.
    pub undone_after: Option<Duration>,
    /// The attract loop begins after nobody has done anything for so long; None where there is none.
    pub attract: Option<Attract>,
    /// How long somebody may hold the volume while another wants it; None without a limit.
    pub longest_hold: Option<Duration>,
}

/// What happens while nobody does anything.
#[derive(Clone, Debug, PartialEq)]
pub struct Attract {
    /// After nobody has done anything for so long.
    pub after: Duration,
    /// How fast the volume turns about the upright axis, radians per second.
    pub turn_per_s: f64,
    /// What those who pass by read.
    pub caption: String,
}

impl Default for Rules {
    /// Those of a display that somebody looks after: nothing is undone and nothing moves by itself.
    fn default() -> Self {
        Self { scales: (0.05, 50.0), farthest_m: 5.0, undone_after: None, attract: None, longest_hold: None }
    }
}
