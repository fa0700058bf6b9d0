//! Tests of OSC packets.

use super::*;
use crate::Pose;
use crate::reading::Reading;
use proptest::prelude::*;
use rosc::OscBundle;
use rosc::encoder::encode;

fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.to_owned(), args })
}

fn floats(numbers: &[f32]) -> Vec<OscType> {
    numbers.iter().map(|&number| OscType::Float(number)).collect()
}

fn parts(packet: &OscPacket) -> Parts {
    parse(&encode(packet).unwrap()).unwrap()
}

#[test]
fn each_address_has_its_meaning() {
    let turn = [0.1, 0.2, 0.3, 0.927_361_8];
    let sent = floats(&[&[1.0, -2.0, 3.5][..], &turn].concat());
    let Ok(Reading { stamp: None, said: Said::Pose(7, Some(pose)) }) =
        parts(&message("/lightloom/pose/7", sent))[0]
    else {
        panic!("no pose");
    };
    assert_eq!(pose.position_m(), DVec3::new(1.0, -2.0, 3.5));
    // x y z w, and not w first.
    assert!((pose.rotation().x - 0.1).abs() < 1e-6 && (pose.rotation().w - 0.927_361_8).abs() < 1e-6);
    for (address, args, said) in [
        ("lost/7", vec![], Said::Pose(7, None)),
        ("button/0", vec![OscType::Int(1)], Said::Button(0, true)),
        ("button/255", vec![OscType::Bool(false)], Said::Button(255, false)),
        ("axis/3", vec![OscType::Double(-0.25)], Said::Axis(3, -0.25)),
    ] {
        assert_eq!(parts(&message(&format!("/lightloom/{address}"), args)), [Ok(said.at(None))]);
    }
}

#[test]
fn a_bundle_says_when_and_a_part_of_it_can_be_refused() {
    let timetag = OscTime { seconds: UNIX_EPOCH_S as u32 + 5, fractional: 1 << 31 };
    let content = vec![
        message("/other", vec![]),
        message("/lightloom/axis/1", floats(&[f32::NAN])),
        message("/lightloom/button/1", vec![OscType::Int(2)]),
        message("/lightloom/pose/1", floats(&[0.0; 7])),
        message("/lightloom/axis/256", floats(&[0.0])),
        message("/lightloom/axis/1", floats(&[0.5])),
    ];
    let bundle = OscPacket::Bundle(OscBundle { timetag, content });
    let stamp = Some(Stamp::Epoch(Duration::from_millis(5500)));
    let refused =
        [Refusal::Unknown, Refusal::NotFinite, Refusal::Form, Refusal::NoQuaternion, Refusal::Index];
    let mut expected: Parts = refused.map(Err).into();
    expected.push(Ok(Said::Axis(1, 0.5).at(stamp)));
    assert_eq!(parts(&bundle), expected);
    assert_eq!(time(OscTime { seconds: 0, fractional: 1 }), None, "at once");
}

#[test]
fn bundles_in_bundles_have_an_end() {
    let nested = |depth: usize| {
        let mut packet = encode(&message("/lightloom/lost/1", vec![])).unwrap();
        for _ in 0..depth {
            let head = [BUNDLE, &[0, 0, 0, 0, 0, 0, 0, 1], &(packet.len() as u32).to_be_bytes()].concat();
            packet = [head, packet].concat();
        }
        packet
    };
    assert_eq!(parse(&nested(MOST_BUNDLES)).unwrap().len(), 1);
    assert_eq!(parse(&nested(MOST_BUNDLES + 1)), Err(Refusal::Form));
    assert_eq!(parse(&nested(3000)), Err(Refusal::Form));
    let lists = [b"/lightloom/axis/1\0\0\0,".to_vec(), vec![b'['; 60_000], vec![0; 4]].concat();
    assert_eq!(parse(&lists), Err(Refusal::Form));
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]
    #[test]
    fn a_written_pose_comes_back(at in prop::array::uniform3(-1e3..1e3_f32), turn in prop::array::uniform4(-1.0..1.0_f32)) {
        let given = DQuat::from_array(turn.map(f64::from));
        prop_assume!((0.6..1.9).contains(&given.length()));
        let parts = parts(&message("/lightloom/pose/0", floats(&[&at[..], &turn].concat())));
        let Ok(Reading { said: Said::Pose(0, Some(pose)), .. }) = parts[0] else { panic!("{parts:?}") };
        prop_assert_eq!(pose.position_m(), DVec3::from_array(at.map(f64::from)));
        // q and −q are one rotation, which a pose has as one of the two.
        let expected = Pose::new(DVec3::ZERO, given).unwrap().rotation();
        prop_assert!((pose.rotation() - expected).length() < 1e-12);
    }
}
