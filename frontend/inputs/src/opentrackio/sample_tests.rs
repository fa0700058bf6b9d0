//! Tests of OpenTrackIO's samples.

use super::*;
use crate::reading::Reading;
use proptest::prelude::*;
use serde_json::{Value, json};

fn transform(at: [f64; 3], turn_deg: [f64; 3]) -> Value {
    json!({"id": "Camera", "translation": {"x": at[0], "y": at[1], "z": at[2]},
           "rotation": {"pan": turn_deg[0], "tilt": turn_deg[1], "roll": turn_deg[2]}})
}

fn sample(transforms: &[Value]) -> Value {
    json!({"protocol": {"name": "OpenTrackIO", "version": [1, 0, 1]}, "lens": {"fStop": 4.0, "distortion": [{"radial": [1, 2]}]},
           "timing": {"sampleTimestamp": {"seconds": 1_718_806_554_u64, "nanoseconds": 500_000_000}},
           "transforms": transforms})
}

fn cbor(value: &Value) -> Vec<u8> {
    let mut bytes = Vec::new();
    ciborium::into_writer(value, &mut bytes).unwrap();
    bytes
}

/// JSON's numbers are read to the last bit but one.
const ROUNDING: f64 = 1e-12;

/// The same, whichever way it is written.
fn reading(value: &Value) -> Result<Reading, Refusal> {
    let by_json = parse(Encoding::Json, value.to_string().as_bytes()).unwrap()[0];
    let by_cbor = parse(Encoding::Cbor, &cbor(value)).unwrap()[0];
    match (by_json, by_cbor) {
        (
            Ok(Reading { said: Said::Pose(SENSOR, Some(a)), stamp: at }),
            Ok(Reading { said: Said::Pose(SENSOR, Some(b)), stamp }),
        ) => {
            assert!((a.position_m() - b.position_m()).length() <= ROUNDING * a.position_m().length());
            assert!((a.rotation() - b.rotation()).length() <= ROUNDING);
            assert_eq!(at, stamp);
        }
        others => assert_eq!(others.0, others.1),
    }
    by_cbor
}

fn pose_of(value: &Value) -> Pose {
    match reading(value).unwrap().said {
        Said::Pose(SENSOR, Some(pose)) => pose,
        other => panic!("{other:?}"),
    }
}

#[test]
fn axes_and_order_are_the_protocol_s() {
    let looks = |turn| pose_of(&sample(&[transform([0.0; 3], turn)])).rotation();
    let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} {b}");
    near(looks([90.0, 0.0, 0.0]) * DVec3::Y, DVec3::NEG_X);
    near(looks([0.0, 90.0, 0.0]) * DVec3::Y, DVec3::Z);
    near(looks([0.0, 0.0, 90.0]) * DVec3::X, DVec3::NEG_Z);
    near(looks([90.0, 30.0, 0.0]) * DVec3::Y, DVec3::new(-(3_f64.sqrt()) / 2.0, 0.0, 0.5));
}

#[test]
fn transforms_are_applied_one_in_the_other() {
    let pose = pose_of(&sample(&[
        transform([1.0, 2.0, 3.0], [90.0, 0.0, 0.0]),
        transform([0.0, 1.0, 0.0], [0.0, 90.0, 0.0]),
    ]));
    assert!((pose.position_m() - DVec3::new(0.0, 2.0, 3.0)).length() < 1e-12);
    assert!((pose.rotation() * DVec3::Y - DVec3::Z).length() < 1e-12);
}

#[test]
fn the_time_is_the_sample_s() {
    let stamp = reading(&sample(&[transform([0.0; 3], [0.0; 3])])).unwrap().stamp;
    assert_eq!(stamp, Some(Stamp::Epoch(Duration::new(1_718_806_554, 500_000_000))));
}

#[test]
fn what_is_no_sample_is_refused() {
    let refused = |text: &str| parse(Encoding::Json, text.as_bytes()).unwrap_err();
    for text in ["", "{", "[]x", "7", r#"{"transforms":[{}]}"#, r#"{"transforms":7}"#] {
        assert_eq!(refused(text), Refusal::Form, "{text}");
    }
    let late = r#"{"timing":{"sampleTimestamp":{"seconds":18446744073709551615,"nanoseconds":4294967295}}}"#;
    assert_eq!(refused(late), Refusal::Form);
    assert_eq!(parse(Encoding::Json, b"{}"), Ok(Parts::new()));
    let far = sample(&[transform([1e300, 0.0, 0.0], [0.0; 3])]);
    assert_eq!(reading(&far), Err(Refusal::TooFar));
    let mut deep = vec![0x81; 60_000];
    deep.push(0);
    assert_eq!(parse(Encoding::Cbor, &deep), Err(Refusal::Form));
    // A text of 2^63 bytes, and a list of as many.
    for lie in [0x7b, 0x9b] {
        assert_eq!(
            parse(Encoding::Cbor, &[lie, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff]),
            Err(Refusal::Form)
        );
    }
    let longer = [cbor(&sample(&[])), vec![0]].concat();
    assert_eq!(parse(Encoding::Cbor, &longer), Err(Refusal::Form));
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]
    #[test]
    fn a_written_pose_comes_back(at in prop::array::uniform3(-1e3..1e3_f64), turn in prop::array::uniform3(-360.0..360.0_f64)) {
        let pose = pose_of(&sample(&[transform(at, turn)]));
        prop_assert_eq!(pose.position_m(), DVec3::from_array(at));
        let expected = turned(&Rotation { pan: turn[0], tilt: turn[1], roll: turn[2] });
        // q and −q are one rotation, which a pose has as one of the two.
        let expected = Pose::new(DVec3::ZERO, expected).unwrap().rotation();
        prop_assert!((pose.rotation() - expected).length() < 1e-12);
    }
}
