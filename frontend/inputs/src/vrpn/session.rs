//! What a VRPN server says, from its descriptions on: names first, then messages with numbers for them.

use super::wire::{self, Message};
use crate::Refusal;
use crate::bytes::Bytes;
use crate::pose::checked_pose;
use crate::reading::{Parts, Said, Stamp};
use glam::{DQuat, DVec3};

/// The types that are read, by the names that servers describe them by.
const KINDS: [(&str, Kind); 4] = [
    ("vrpn_Tracker Pos_Quat", Kind::Pose),
    ("vrpn_Button Change", Kind::Button),
    ("vrpn_Button States", Kind::Buttons),
    ("vrpn_Analog Channel", Kind::Analog),
];
/// A server describes its devices once, types and devices each by numbers of its own.
const MOST_BUTTONS: usize = 256;
const MOST_CHANNELS: usize = 128;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Pose,
    Button,
    Buttons,
    Analog,
}

/// What is known of a server since it was found: the number of one device, and the numbers of the types that are read.
#[derive(Debug)]
pub struct Session {
    device: String,
    sender: Option<i32>,
    kinds: [Option<i32>; KINDS.len()],
}

impl Session {
    /// With a server of which nothing is known; a device of it is heard.
    pub fn new(device: &str) -> Self {
        Self { device: device.to_owned(), sender: None, kinds: [None; KINDS.len()] }
    }

    /// What a message says. Those of other devices and types say nothing.
    ///
    /// # Errors
    /// A payload that is not that of its type. A pose that is none is refused by itself.
    pub fn heard(&mut self, message: &Message<'_>) -> Result<Parts, Refusal> {
        match message.kind {
            wire::SENDER => {
                if wire::name(message.payload)? == self.device {
                    self.sender = Some(message.sender);
                }
                Ok(Parts::new())
            }
            wire::TYPE => {
                let name = wire::name(message.payload)?;
                if let Some(place) = KINDS.iter().position(|(known, _)| *known == name) {
                    self.kinds[place] = Some(message.sender);
                }
                Ok(Parts::new())
            }
            _ if self.sender != Some(message.sender) => Ok(Parts::new()),
            kind => {
                let Some(place) = self.kinds.iter().position(|known| *known == Some(kind)) else {
                    return Ok(Parts::new());
                };
                let said = said(KINDS[place].1, message.payload)?;
                let stamp = Some(Stamp::Epoch(message.time));
                Ok(said.into_iter().map(|said| said.map(|said| said.at(stamp))).collect())
            }
        }
    }

    /// Whether the server has the device.
    pub const fn has_device(&self) -> bool {
        self.sender.is_some()
    }
}

type Sayings = Vec<Result<Said, Refusal>>;

fn said(kind: Kind, payload: &[u8]) -> Result<Sayings, Refusal> {
    let mut bytes = Bytes(payload);
    let said = match kind {
        Kind::Pose => vec![pose(&mut bytes)?],
        Kind::Button => {
            let (index, state) = (bytes.i32()?, bytes.i32()?);
            vec![u8::try_from(index).map(|index| Said::Button(index, state != 0)).map_err(|_| Refusal::Index)]
        }
        Kind::Buttons => {
            let count = usize::try_from(bytes.i32()?).map_err(|_| Refusal::Index)?;
            let indices = (0..=u8::MAX).take(within(count, MOST_BUTTONS)?);
            indices
                .map(|index| Ok(Ok(Said::Button(index, bytes.i32()? != 0))))
                .collect::<Result<_, Refusal>>()?
        }
        Kind::Analog => {
            let count = bytes.f64()?;
            // A number that is NaN, negative or too large becomes one that is refused.
            let count = if count.fract() == 0.0 && count >= 0.0 { count as usize } else { usize::MAX };
            let indices = (0..=u8::MAX).take(within(count, MOST_CHANNELS)?);
            indices.map(|index| Ok(Said::axis(index, bytes.f64()?))).collect::<Result<_, Refusal>>()?
        }
    };
    if bytes.0.is_empty() { Ok(said) } else { Err(Refusal::Long) }
}

fn within(count: usize, most: usize) -> Result<usize, Refusal> {
    if count <= most { Ok(count) } else { Err(Refusal::Index) }
}

/// A sensor, padding, a position in metres, and a quaternion in the order x, y, z, w.
fn pose(bytes: &mut Bytes<'_>) -> Result<Result<Said, Refusal>, Refusal> {
    let (sensor, _padding) = (bytes.i32()?, bytes.i32()?);
    let mut numbers = [0.0; 7];
    for number in &mut numbers {
        *number = bytes.f64()?;
    }
    let [x, y, z, qx, qy, qz, qw] = numbers;
    let Ok(sensor) = u8::try_from(sensor) else { return Ok(Err(Refusal::Index)) };
    let pose = checked_pose(DVec3::new(x, y, z), DQuat::from_xyzw(qx, qy, qz, qw));
    Ok(pose.map(|pose| Said::Pose(sensor, Some(pose))))
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;
