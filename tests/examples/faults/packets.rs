//! What wands say, in each protocol.

use inputs::vrpn::wire::{self, Message};
use rosc::{OscMessage, OscPacket, OscType};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Schedules stand this far apart along x, metres, so that a pose tells after which it was measured.
const APART_M: f64 = 1e-3;
/// Where those stand that are sent during a fault: no schedule is there.
pub const DURING_M: f64 = -0.5;

/// Where poses are after a schedule.
pub fn place_m(schedule: u32) -> f64 {
    f64::from(schedule) * APART_M
}

/// The schedule that a pose was measured after.
pub fn schedule_at(x_m: f64) -> Option<u32> {
    let schedule = (x_m / APART_M).round();
    ((x_m - schedule * APART_M).abs() < 0.01 * APART_M && schedule >= 0.0).then_some(schedule as u32)
}

/// A frame of DTrack with a body, and a Flystick whose button is down or not.
pub fn dtrack(x_m: f64, count: u64) -> Vec<u8> {
    format!(
        "fr {count}\nts {}.0\n6d 1 [0 1.000][{:.4} 0 100 0 0 0][1 0 0 0 1 0 0 0 1]\n",
        count % 86_400,
        1e3 * x_m
    )
    .into_bytes()
}

/// A pose over OSC.
pub fn osc(x_m: f64) -> Vec<u8> {
    let args = [x_m as f32, 0.1, 0.2, 0.0, 0.0, 0.0, 1.0].map(OscType::Float).into();
    let message = OscMessage { addr: "/lightloom/pose/0".to_owned(), args };
    rosc::encoder::encode(&OscPacket::Message(message)).expect("a pose can be written")
}

/// The device of the VRPN server.
pub const DEVICE: &str = "Wand";

fn message(sender: i32, kind: i32, payload: &[u8]) -> Vec<u8> {
    let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or(Duration::ZERO);
    wire::write(&Message { time, sender, kind, payload }, 0)
}

fn described(kind: i32, name: &str) -> Vec<u8> {
    message(0, kind, &[&(name.len() as u32 + 1).to_be_bytes()[..], name.as_bytes(), &[0]].concat())
}

/// What a VRPN server says first: its device, and that this sends poses.
pub fn vrpn_descriptions() -> Vec<u8> {
    [described(wire::SENDER, DEVICE), described(wire::TYPE, "vrpn_Tracker Pos_Quat")].concat()
}

/// A pose of its sensor 0.
pub fn vrpn(x_m: f64) -> Vec<u8> {
    let numbers = [x_m, -0.1, 0.2, 0.0, 0.0, 0.0, 1.0].into_iter().flat_map(f64::to_be_bytes);
    message(0, 0, &[0; 8].into_iter().chain(numbers).collect::<Vec<u8>>())
}
