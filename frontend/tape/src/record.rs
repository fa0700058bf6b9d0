//! What a tape holds, one after the other.

use serde::{Deserialize, Serialize};
use std::time::Duration;
use world::{Deed, Moment};

/// One thing. The order of a tape's records is the order in which they reached the world.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// Something happened.
    Deed(Deed),
    /// A frame was made of all before.
    Frame(Frame),
    /// Something was said.
    Said(Said),
}

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Frame {
    /// Its number.
    pub frame: u32,
    /// When it was made, on the display's clock, nanoseconds.
    pub now_ns: u64,
    /// When it was to be seen.
    pub seen_at_ns: u64,
    /// A number that differs where the frame does: that of a frame that is made again can be compared.
    #[serde(with = "hex")]
    pub check: u64,
}

impl Frame {
    /// The frame of a moment.
    pub fn new(frame: u32, moment: Moment, check: u64) -> Self {
        Self { frame, now_ns: nanoseconds(moment.now), seen_at_ns: nanoseconds(moment.seen_at), check }
    }

    /// Its moment.
    pub fn moment(&self) -> Moment {
        Moment { now: Duration::from_nanos(self.now_ns), seen_at: Duration::from_nanos(self.seen_at_ns) }
    }
}

/// A sentence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Said {
    /// When, on the display's clock, nanoseconds.
    pub now_ns: u64,
    /// The sentence.
    pub text: String,
}

/// A number as 16 hexadecimal digits: not every reader of JSON has 64 bits.
mod hex {
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(number: &u64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&format!("{number:016x}"))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
        let digits = String::deserialize(deserializer)?;
        u64::from_str_radix(&digits, 16).map_err(|_| D::Error::custom("16 hexadecimal digits are expected"))
    }
}

/// Nanoseconds of a time; the largest number for 584 years and more.
pub fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}
