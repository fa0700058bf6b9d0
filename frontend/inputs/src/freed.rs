//! FreeD: camera poses in messages of type D1 (Vinten Radamec, free-d installation manual 1.4.4, appendices A.3.2 and B).

use crate::Refusal;
use crate::bytes::Bytes;
use crate::pose::checked_pose;
use crate::reading::{Parts, Said};
use glam::{DQuat, DVec3};

/// Bytes of a message, and what it begins with.
const LENGTH: usize = 29;
const POSITION_AND_ORIENTATION: u8 = 0xd1;
/// The checksum is this number, less all bytes before it.
const CHECKSUM_FROM: u8 = 0x40;
const UNITS_PER_DEGREE: f64 = 32_768.0;
const UNITS_PER_METRE: f64 = 64_000.0;

/// The pose that a D1 message carries; its sensor is the camera's number. Zoom and focus are no concern of ours.
///
/// # Errors
/// Another length, type or checksum; a pose that is none.
pub fn parse(message: &[u8]) -> Result<Parts, Refusal> {
    if message.len() != LENGTH {
        return Err(if message.len() < LENGTH { Refusal::Short } else { Refusal::Long });
    }
    let (&checksum, summed) = message.split_last().ok_or(Refusal::Short)?;
    if summed.iter().fold(CHECKSUM_FROM, |rest, &byte| rest.wrapping_sub(byte)) != checksum {
        return Err(Refusal::Checksum);
    }
    let mut bytes = Bytes(summed);
    let [kind, camera] = bytes.array()?;
    if kind != POSITION_AND_ORIENTATION {
        return Err(Refusal::Foreign);
    }
    let mut numbers = [0.0; 6];
    for number in &mut numbers {
        *number = f64::from(bytes.i24()?);
    }
    let [pan, tilt, roll, x, y, z] = numbers;
    let angle = |units: f64| (units / UNITS_PER_DEGREE).to_radians();
    let pose =
        checked_pose(DVec3::new(x, y, z) / UNITS_PER_METRE, turned(angle(pan), angle(tilt), angle(roll)))?;
    Ok(vec![Ok(Said::Pose(camera, Some(pose)).at(None))])
}

/// A camera that looks along y, with z up, and turns by radians: pan to its right, tilt upward, roll clockwise as seen from
/// behind it (appendix B.2 to B.4).
fn turned(pan: f64, tilt: f64, roll: f64) -> DQuat {
    DQuat::from_rotation_z(-pan) * DQuat::from_rotation_x(tilt) * DQuat::from_rotation_y(roll)
}

#[cfg(test)]
#[path = "freed_tests.rs"]
mod tests;
