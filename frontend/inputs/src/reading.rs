//! What a message says, before anybody knows when it arrived.

use crate::{Pose, Refusal};
use std::time::Duration;

/// A stamp that a message carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stamp {
    /// Since the Unix epoch, by the device's clock.
    Epoch(Duration),
    /// Since whenever the device began to count.
    Own(Duration),
}

/// One thing that a message says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Said {
    /// The pose of a sensor; absent where its target is lost.
    Pose(u8, Option<Pose>),
    /// Whether a button is down, changed or not.
    Button(u8, bool),
    /// Where an axis stands; always finite.
    Axis(u8, f64),
}

/// What a message says, and when it was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// When, if the message says so.
    pub stamp: Option<Stamp>,
    /// What.
    pub said: Said,
}

/// What there is of a message: the rest is taken where a part of it is refused.
pub type Parts = Vec<Result<Reading, Refusal>>;

impl Said {
    /// Where an axis stands.
    ///
    /// # Errors
    /// The number is not finite.
    pub fn axis(index: u8, value: f64) -> Result<Self, Refusal> {
        if value.is_finite() { Ok(Self::Axis(index, value)) } else { Err(Refusal::NotFinite) }
    }

    /// This, at a time.
    pub const fn at(self, stamp: Option<Stamp>) -> Reading {
        Reading { stamp, said: self }
    }
}
