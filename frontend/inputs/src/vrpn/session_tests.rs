//! Tests of a conversation with a VRPN server.

use super::*;
use crate::Pose;
use proptest::prelude::*;
use std::time::Duration;

const TIME: Duration = Duration::from_secs(1_700_000_000);
const DEVICE: i32 = 4;

fn heard(session: &mut Session, sender: i32, kind: i32, payload: &[u8]) -> Result<Parts, Refusal> {
    session.heard(&Message { time: TIME, sender, kind, payload })
}

fn named(name: &str) -> Vec<u8> {
    [&(name.len() as u32 + 1).to_be_bytes()[..], name.as_bytes(), &[0]].concat()
}

/// A session that knows the device as 4, and types from 10 on.
fn session() -> Session {
    let mut session = Session::new("Wand");
    heard(&mut session, 0, wire::SENDER, &named("Other")).unwrap();
    heard(&mut session, DEVICE, wire::SENDER, &named("Wand")).unwrap();
    for (number, (name, _)) in (10..).zip(KINDS) {
        heard(&mut session, number, wire::TYPE, &named(name)).unwrap();
    }
    session
}

fn doubles(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_be_bytes()).collect()
}

fn ints(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_be_bytes()).collect()
}

fn pose_payload(sensor: i32, numbers: [f64; 7]) -> Vec<u8> {
    [ints(&[sensor, 0]), doubles(&numbers)].concat()
}

fn said_by(payload: &[u8], kind: i32) -> Result<Vec<Result<Said, Refusal>>, Refusal> {
    let parts = heard(&mut session(), DEVICE, kind, payload)?;
    assert!(parts.iter().flatten().all(|reading| reading.stamp == Some(Stamp::Epoch(TIME))));
    Ok(parts.into_iter().map(|part| part.map(|reading| reading.said)).collect())
}

#[test]
fn poses_are_in_metres_with_w_last() {
    let payload = pose_payload(2, [1.0, -2.0, 3.0, 0.5, -0.5, 0.1, 0.7]);
    let said = said_by(&payload, 10).unwrap();
    let [Ok(Said::Pose(2, Some(pose)))] = said[..] else { panic!("{said:?}") };
    let expected = DQuat::from_xyzw(0.5, -0.5, 0.1, 0.7).normalize();
    assert_eq!(pose.position_m(), DVec3::new(1.0, -2.0, 3.0));
    assert!((pose.rotation() - expected).length() < 1e-12);
}

#[test]
fn buttons_and_channels_are_numbered() {
    assert_eq!(said_by(&ints(&[3, 1]), 11), Ok(vec![Ok(Said::Button(3, true))]));
    assert_eq!(
        said_by(&ints(&[2, 0, 1]), 12),
        Ok(vec![Ok(Said::Button(0, false)), Ok(Said::Button(1, true))])
    );
    let channels = said_by(&doubles(&[3.0, 0.5, f64::NAN, -1.0]), 13);
    assert_eq!(channels, Ok(vec![Ok(Said::Axis(0, 0.5)), Err(Refusal::NotFinite), Ok(Said::Axis(2, -1.0))]));
}

#[test]
fn lies_are_refused() {
    for (payload, kind, refusal) in [
        (ints(&[-1, 1]), 11, Ok(vec![Err(Refusal::Index)])),
        (ints(&[256, 1]), 11, Ok(vec![Err(Refusal::Index)])),
        (ints(&[1]), 11, Err(Refusal::Short)),
        (ints(&[1, 1, 1]), 11, Err(Refusal::Long)),
        (ints(&[i32::MAX]), 12, Err(Refusal::Index)),
        (ints(&[256]), 12, Err(Refusal::Short)),
        (doubles(&[1e300]), 13, Err(Refusal::Index)),
        (doubles(&[f64::NAN]), 13, Err(Refusal::Index)),
        (doubles(&[-1.0]), 13, Err(Refusal::Index)),
        (doubles(&[2.0, 1.0]), 13, Err(Refusal::Short)),
        (pose_payload(300, [0.0; 7]), 10, Ok(vec![Err(Refusal::Index)])),
        (pose_payload(0, [0.0; 7]), 10, Ok(vec![Err(Refusal::NoQuaternion)])),
        (pose_payload(0, [f64::NAN; 7]), 10, Ok(vec![Err(Refusal::NotFinite)])),
    ] {
        assert_eq!(said_by(&payload, kind), refusal, "{payload:?}");
    }
}

#[test]
fn others_say_nothing() {
    let mut session = session();
    let payload = ints(&[3, 1]);
    assert_eq!(heard(&mut session, 0, 11, &payload), Ok(vec![]), "another device");
    assert_eq!(heard(&mut session, DEVICE, 99, &payload), Ok(vec![]), "another type");
    let mut ignorant = Session::new("Wand");
    assert_eq!(heard(&mut ignorant, DEVICE, 11, &payload), Ok(vec![]), "before any description");
    assert!(session.has_device() && !ignorant.has_device());
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]
    #[test]
    fn a_written_pose_comes_back(sensor in 0..256_i32, at in prop::array::uniform3(-1e3..1e3_f64), turn in prop::array::uniform4(-1.0..1.0_f64)) {
        let given = DQuat::from_array(turn);
        prop_assume!((0.6..1.9).contains(&given.length()));
        let payload = pose_payload(sensor, [at[0], at[1], at[2], turn[0], turn[1], turn[2], turn[3]]);
        let said = said_by(&payload, 10).unwrap();
        let expected = Pose::new(DVec3::from_array(at), given).unwrap();
        prop_assert_eq!(&said[..], &[Ok(Said::Pose(sensor as u8, Some(expected)))]);
    }
}
