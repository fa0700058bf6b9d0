//! Open Sound Control: what programs and phones send to the addresses of this program.

use crate::Refusal;
use crate::pose::checked_pose;
use crate::reading::{Parts, Said, Stamp};
use glam::{DQuat, DVec3};
use rosc::{OscMessage, OscPacket, OscTime, OscType};
use std::time::Duration;

/// What all addresses begin with.
const ROOT: &str = "/lightloom/";
/// What a bundle begins with. The decoder calls itself for each bundle in a bundle, and for each list in a list.
const BUNDLE: &[u8] = b"#bundle\0";
const MOST_BUNDLES: usize = 16;
const MOST_LISTS: usize = 64;
/// From the epoch of OSC (1900) to that of Unix (1970), seconds.
const UNIX_EPOCH_S: u64 = 2_208_988_800;

/// What a packet says: a message or a bundle of them, at one of these addresses, n from 0 to 255.
///
/// | address | arguments |
/// | --- | --- |
/// | `/lightloom/pose/n` | `x y z` in metres and the quaternion `x y z w`, all floats or doubles |
/// | `/lightloom/lost/n` | none: the target is lost |
/// | `/lightloom/button/n` | 0 or 1 |
/// | `/lightloom/axis/n` | a number |
///
/// # Errors
/// Not a packet of OSC. A message of another address or with other arguments is refused by itself.
pub fn parse(packet: &[u8]) -> Result<Parts, Refusal> {
    let bundles = packet.windows(BUNDLE.len()).filter(|window| *window == BUNDLE).count();
    let lists = packet.iter().filter(|&&byte| byte == b'[').count();
    if bundles > MOST_BUNDLES || lists > MOST_LISTS {
        return Err(Refusal::Form);
    }
    let (rest, packet) = rosc::decoder::decode_udp(packet).map_err(|_| Refusal::Form)?;
    if !rest.is_empty() {
        return Err(Refusal::Long);
    }
    let mut parts = Parts::new();
    collect(&packet, None, &mut parts);
    Ok(parts)
}

fn collect(packet: &OscPacket, stamp: Option<Stamp>, parts: &mut Parts) {
    match packet {
        OscPacket::Message(message) => parts.push(said(message).map(|said| said.at(stamp))),
        OscPacket::Bundle(bundle) => {
            let stamp = time(bundle.timetag);
            bundle.content.iter().for_each(|packet| collect(packet, stamp, parts));
        }
    }
}

/// The time of a bundle; the time 0.1 stands for "at once", and says nothing.
fn time(tag: OscTime) -> Option<Stamp> {
    let seconds = u64::from(tag.seconds).checked_sub(UNIX_EPOCH_S)?;
    let nanoseconds = (u64::from(tag.fractional) * 1_000_000_000) >> 32;
    Some(Stamp::Epoch(Duration::new(seconds, nanoseconds as u32)))
}

fn said(message: &OscMessage) -> Result<Said, Refusal> {
    let path = message.addr.strip_prefix(ROOT).ok_or(Refusal::Unknown)?;
    let (kind, index) = path.split_once('/').ok_or(Refusal::Unknown)?;
    let index: u8 = index.parse().map_err(|_| Refusal::Index)?;
    let numbers = message.args.iter().map(number).collect::<Option<Vec<f64>>>().ok_or(Refusal::Form)?;
    match (kind, numbers.as_slice()) {
        ("pose", &[x, y, z, qx, qy, qz, qw]) => {
            let pose = checked_pose(DVec3::new(x, y, z), DQuat::from_xyzw(qx, qy, qz, qw))?;
            Ok(Said::Pose(index, Some(pose)))
        }
        ("lost", []) => Ok(Said::Pose(index, None)),
        ("button", &[number]) if number == 0.0 || number == 1.0 => Ok(Said::Button(index, number == 1.0)),
        ("axis", &[value]) => Said::axis(index, value),
        ("pose" | "lost" | "button" | "axis", _) => Err(Refusal::Form),
        _ => Err(Refusal::Unknown),
    }
}

fn number(argument: &OscType) -> Option<f64> {
    match *argument {
        OscType::Float(number) => Some(f64::from(number)),
        OscType::Double(number) => Some(number),
        OscType::Int(number) => Some(f64::from(number)),
        OscType::Bool(is_true) => Some(f64::from(u8::from(is_true))),
        _ => None,
    }
}

#[cfg(test)]
#[path = "osc_tests.rs"]
mod tests;
