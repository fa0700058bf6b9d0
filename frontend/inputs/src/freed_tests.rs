//! Tests of FreeD messages.

use super::*;
use crate::Pose;
use proptest::prelude::*;

/// A message as the manual lays it out, from degrees and metres.
fn message(camera: u8, angles_deg: [f64; 3], position_m: [f64; 3]) -> Vec<u8> {
    let mut bytes = vec![0xd1, camera];
    let units = angles_deg.map(|a| a * 32_768.0).into_iter().chain(position_m.map(|p| p * 64_000.0));
    units.for_each(|units| bytes.extend(&(units.round() as i32).to_be_bytes()[1..]));
    bytes.extend([0; 8]);
    bytes.push(bytes.iter().fold(0x40, |rest: u8, byte| rest.wrapping_sub(*byte)));
    bytes
}

fn pose(message: &[u8]) -> Pose {
    match parse(message).unwrap().as_slice() {
        [Ok(crate::reading::Reading { said: Said::Pose(_, Some(pose)), .. })] => *pose,
        other => panic!("{other:?}"),
    }
}

/// Where a camera that is turned by degrees looks, and what is to its right.
fn looks(angles_deg: [f64; 3]) -> (DVec3, DVec3) {
    let turn = pose(&message(1, angles_deg, [0.0; 3])).rotation();
    (turn * DVec3::Y, turn * DVec3::X)
}

#[test]
fn signs_and_units_are_the_manual_s() {
    assert_eq!(looks([0.0; 3]), (DVec3::Y, DVec3::X));
    let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-6, "{a} {b}");
    near(looks([90.0, 0.0, 0.0]).0, DVec3::X);
    near(looks([0.0, 90.0, 0.0]).0, DVec3::Z);
    near(looks([0.0, 0.0, 90.0]).1, DVec3::NEG_Z);
    // Pan comes first: then a tilted camera looks as high up, only elsewhere.
    near(looks([90.0, 30.0, 0.0]).0, DVec3::new(3_f64.sqrt() / 2.0, 0.0, 0.5));
    let hex = message(7, [-180.0, 0.0, 0.0], [-131.072, 0.0, 0.0]);
    assert_eq!(hex[2..5], [0xa6, 0, 0], "-180 degrees are A60000");
    assert_eq!(hex[11..14], [0x80, 0, 0], "-131072 mm are 800000");
    assert_eq!(pose(&hex).position_m().x, -131.072);
}

#[test]
fn what_is_no_message_is_refused() {
    let good = message(1, [10.0, 20.0, 30.0], [1.0, 2.0, 3.0]);
    assert!(parse(&good).is_ok());
    for length in 0..good.len() {
        assert_eq!(parse(&good[..length]), Err(Refusal::Short));
    }
    assert_eq!(parse(&[&good[..], &[0]].concat()), Err(Refusal::Long));
    for bit in 0..8 * good.len() {
        let mut spoiled = good.clone();
        spoiled[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(parse(&spoiled), Err(Refusal::Checksum));
    }
    let mut other = good;
    (other[0], other[28]) = (0xd2, other[28].wrapping_sub(1));
    assert_eq!(parse(&other), Err(Refusal::Foreign));
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]
    #[test]
    fn a_written_pose_comes_back(angles in prop::array::uniform3(-179.0..179.0_f64), at in prop::array::uniform3(-100.0..100.0_f64)) {
        let pose = pose(&message(9, angles, at));
        prop_assert!((pose.position_m() - DVec3::from_array(at)).abs().max_element() <= 0.5 / 64_000.0 + 1e-12);
        let [pan, tilt, roll] = angles.map(f64::to_radians);
        let off = pose.rotation().angle_between(turned(pan, tilt, roll));
        // Three roundings to half of 1/32768 degree; the arc cosine of a number near 1 adds the rest.
        prop_assert!(off <= 3.0 * (0.5 / 32_768.0_f64).to_radians() + 1e-7, "{off}");
    }
}
