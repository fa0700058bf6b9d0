//! What happens at a source.

use crate::Pose;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// A source's place in its input file, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SourceId(pub u16);

/// Something that happened at a source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Where.
    pub source: SourceId,
    /// When the device measured it, if it says so.
    pub device_time: Option<DeviceTime>,
    /// When it arrived, on the clock of whoever asks.
    pub received: Duration,
    /// What.
    pub what: What,
}

impl Event {
    /// When it was measured, on the clock of [`Event::received`]; when it arrived, where the device does not say.
    pub fn measured(&self) -> Duration {
        match self.device_time {
            Some(DeviceTime::InStep(time)) => time,
            Some(DeviceTime::Own(_)) | None => self.received,
        }
    }
}

/// When a device measured something.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DeviceTime {
    /// On the clock of [`Event::received`]: the device's clock and this host's both show the time of day. It is 0 for what was
    /// measured before that clock began.
    InStep(Duration),
    /// On a clock of the device's own: only differences mean something.
    Own(Duration),
}

/// What happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum What {
    /// A sensor's pose.
    Pose {
        /// The sensor's number.
        sensor: u8,
        /// In the display's frame where its input has a calibration, and else in the tracker's own. Absent where its target is
        /// lost: a lost target is no pose.
        pose: Option<Pose>,
    },
    /// A button went down or up.
    Button {
        /// The button's number.
        index: u8,
        /// Whether it is down now.
        is_down: bool,
    },
    /// An axis moved.
    Axis {
        /// The axis' number.
        index: u8,
        /// From −1 to 1 for most devices; always finite.
        value: f64,
    },
    /// The source is there, from now on; in a sentence.
    Found(String),
    /// The source is not there any more, and is looked for; in a sentence. Its buttons are up by then.
    Lost(String),
}
