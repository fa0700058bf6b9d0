//! A sample of OpenTrackIO: where a camera is, at one time.

use super::packet::Encoding;
use crate::pose::checked_pose;
use crate::reading::{Parts, Said, Stamp};
use crate::{Pose, Refusal};
use glam::{DQuat, DVec3};
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt::{self, Formatter};
use std::time::Duration;

/// Depth of lists in lists that CBOR may have; samples have five.
const DEEPEST: usize = 32;
/// A sample's own camera.
const SENSOR: u8 = 0;

/// What is read of a sample; all that it says of lenses and the like is passed over.
#[derive(Deserialize)]
struct Sample {
    transforms: Option<Transforms>,
    timing: Option<Timing>,
}

/// Serde's own lists reserve up to a megabyte for what CBOR claims; this one grows with what is read.
#[derive(Default)]
struct Transforms(Vec<Transform>);

impl<'de> Deserialize<'de> for Transforms {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(TransformsVisitor)
    }
}

struct TransformsVisitor;

impl<'de> Visitor<'de> for TransformsVisitor {
    type Value = Transforms;

    fn expecting(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str("a list of transforms")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Transforms, A::Error> {
        let mut transforms = Vec::new();
        while let Some(transform) = list.next_element()? {
            transforms.push(transform);
        }
        Ok(Transforms(transforms))
    }
}

#[derive(Deserialize)]
struct Transform {
    translation: Translation,
    rotation: Rotation,
}

/// Metres.
#[derive(Deserialize)]
struct Translation {
    x: f64,
    y: f64,
    z: f64,
}

/// Degrees.
#[derive(Deserialize)]
struct Rotation {
    pan: f64,
    tilt: f64,
    roll: f64,
}

#[derive(Deserialize)]
struct Timing {
    #[serde(rename = "sampleTimestamp")]
    sample_timestamp: Option<Timestamp>,
}

#[derive(Deserialize)]
struct Timestamp {
    seconds: u64,
    nanoseconds: u32,
}

/// What a sample says: the pose of the camera, as sensor 0. One without transforms says nothing of it.
///
/// # Errors
/// Not the JSON or CBOR of a sample. A pose that is none is refused by itself.
pub fn parse(encoding: Encoding, payload: &[u8]) -> Result<Parts, Refusal> {
    let sample: Sample = match encoding {
        Encoding::Json => serde_json::from_slice(payload).map_err(|_| Refusal::Form)?,
        Encoding::Cbor => {
            let mut rest = payload;
            let sample = ciborium::de::from_reader_with_recursion_limit(&mut rest, DEEPEST);
            sample.ok().filter(|_| rest.is_empty()).ok_or(Refusal::Form)?
        }
    };
    let stamp = match sample.timing.and_then(|timing| timing.sample_timestamp) {
        Some(Timestamp { nanoseconds: 1_000_000_000.., .. }) => return Err(Refusal::Form),
        Some(time) => Some(Stamp::Epoch(Duration::new(time.seconds, time.nanoseconds))),
        None => None,
    };
    let Transforms(transforms) = sample.transforms.unwrap_or_default();
    if transforms.is_empty() {
        return Ok(Parts::new());
    }
    Ok(vec![pose(&transforms).map(|pose| Said::Pose(SENSOR, Some(pose)).at(stamp))])
}

/// Transforms one after the other, the first outermost.
fn pose(transforms: &[Transform]) -> Result<Pose, Refusal> {
    let (mut position_m, mut orientation) = (DVec3::ZERO, DQuat::IDENTITY);
    for Transform { translation: t, rotation } in transforms {
        position_m += orientation * DVec3::new(t.x, t.y, t.z);
        orientation *= turned(rotation);
    }
    checked_pose(position_m, orientation)
}

/// A camera that looks along y with z up; its turns are about its own z, x and y axes in this order, each clockwise as seen
/// along the axis.
fn turned(rotation: &Rotation) -> DQuat {
    let Rotation { pan, tilt, roll } = rotation;
    let turn_z = DQuat::from_rotation_z(pan.to_radians());
    turn_z * DQuat::from_rotation_x(tilt.to_radians()) * DQuat::from_rotation_y(roll.to_radians())
}

#[cfg(test)]
#[path = "sample_tests.rs"]
mod tests;
