//! Tests of DTrack's lines.

use super::*;
use crate::Pose;
use glam::{DQuat, EulerRot};
use proptest::prelude::*;

/// The manual's own line (appendix B.2.3).
const BODY: &str = "6d 1 [0 1.000][326.848 -187.216 109.503 -160.4704 -3.6963 -7.0913][-0.940508 -0.339238 -0.019025 \
                    0.333599 -0.932599 0.137735 -0.064467 0.123194 0.990286]";
/// The manual's own line (appendix B.2.7).
const TOOL: &str = "6dmt2 1 1 [0 1.000 4 2.000][326.848 -187.216 109.503][0.911812 -0.038421 0.408806 0.095040 0.988324 \
                    -0.119094 -0.399457 0.147444 0.904817][5] [8.178e-04 9.166e-04 1.084e-03 4.463e-02 9.025e-03 1.286e-02]";
const LOST_FLYSTICK: &str = "6df2 1 1 [1 -1.000 6 2][0.000 0.000 0.000][0.000000 0.000000 0.000000 0.000000 0.000000 \
                             0.000000 0.000000 0.000000 0.000000][34 -0.50 1.00]";

fn said(line: &str) -> Vec<Result<Said, Refusal>> {
    parse(line.as_bytes()).unwrap().parts.into_iter().map(|part| part.map(|reading| reading.said)).collect()
}

fn pose(line: &str) -> Pose {
    match said(line)[0] {
        Ok(Said::Pose(_, Some(pose))) => pose,
        other => panic!("{other:?}"),
    }
}

/// The angles that the manual prints beside the same matrix are an oracle of its order: R = Rx(η) Ry(θ) Rz(φ).
#[test]
fn the_matrix_goes_column_by_column() {
    let pose = pose(BODY);
    assert!((pose.position_m() - DVec3::new(0.326848, -0.187216, 0.109503)).length() < 1e-12);
    let [phi, theta, eta] = [-160.4704_f64, -3.6963, -7.0913].map(f64::to_radians);
    let expected = DQuat::from_euler(EulerRot::XYZ, eta, theta, phi);
    assert!(pose.rotation().angle_between(expected) < 1e-5);
    assert!(pose.rotation().angle_between(expected.inverse()) > 0.1, "the canary: row by row");
}

#[test]
fn a_flystick_that_is_lost_has_buttons_and_no_pose() {
    let said = said(LOST_FLYSTICK);
    assert_eq!(said[0], Ok(Said::Pose(101, None)));
    let down: Vec<u8> = said
        .iter()
        .filter_map(|part| match part {
            Ok(Said::Button(index, true)) => Some(*index),
            _ => None,
        })
        .collect();
    assert_eq!(down, [16 + 1, 16 + 5]);
    assert_eq!(said[7..], [Ok(Said::Axis(8, -0.5)), Ok(Said::Axis(9, 1.0))]);
}

#[test]
fn a_tool_has_a_pose_and_buttons() {
    let said = said(TOOL);
    assert!(matches!(said[0], Ok(Said::Pose(200, Some(_)))));
    assert_eq!(
        said[1..],
        [true, false, true, false]
            .map(|down| down)
            .iter()
            .zip(128..)
            .map(|(&down, i)| Ok(Said::Button(i, down)))
            .collect::<Vec<_>>()
    );
}

#[test]
fn zero_matrices_and_nan_are_refused_each_by_itself() {
    let zeros = "6d 2 [0 1.000][0 0 0 0 0 0][0 0 0 0 0 0 0 0 0] [1 1.000][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1]";
    let said = said(zeros);
    assert_eq!(said[0], Err(Refusal::NoRotation));
    assert!(matches!(said[1], Ok(Said::Pose(1, Some(_)))));
    let nan = BODY.replace("326.848", "nan");
    assert_eq!(parse(nan.as_bytes()).unwrap().parts, [Err(Refusal::NotFinite)]);
}

#[test]
fn a_body_that_is_listed_no_more_is_lost_once() {
    let mut dtrack = Dtrack::default();
    let mut lost = |datagram: &str| {
        let parts = dtrack.decode(datagram.as_bytes()).unwrap();
        parts.iter().filter(|part| matches!(part, Ok(Reading { said: Said::Pose(0, None), .. }))).count()
    };
    assert_eq!([lost(BODY), lost("fr 2"), lost("6d 0"), lost("6d 0"), lost(BODY)], [0, 0, 1, 0, 0]);
}

#[test]
fn times_are_those_of_the_day() {
    let frame = parse(format!("fr 21753\r\nts 39596.024831\r\n6dcal 3\r\n{BODY}\r\n\0").as_bytes()).unwrap();
    let Ok(Reading { stamp: Some(Stamp::Own(time)), .. }) = frame.parts[0] else { panic!("{frame:?}") };
    assert!((time.as_secs_f64() - 39_596.024_831).abs() < 1e-9);
    assert_eq!(frame.bodies, Some(vec![0]));
}

#[test]
fn lines_of_another_form_are_refused() {
    let spoiled = [
        BODY.replace("6d 1", "6d 2"),
        BODY.replace("6d 1", "6d"),
        BODY.replace("[0 1.000]", "[0]"),
        BODY.replace("0.990286]", "0.990286"),
        BODY.replace("0.990286", "0.990286 7"),
        TOOL.replace("6dmt2 1 1", "6dmt2 1"),
        LOST_FLYSTICK.replace(" 1.00]", "]"),
        LOST_FLYSTICK.replace("6 2]", "600 2]"),
        "ts yesterday".to_owned(),
    ];
    for line in spoiled {
        let parts = parse(line.as_bytes()).map(|frame| frame.parts);
        assert!(matches!(parts, Err(Refusal::Form | Refusal::Index)), "{line}: {parts:?}");
    }
    for foreign in ["", "\0", "hello", "3d 0", "6dé 1"] {
        assert_eq!(parse(foreign.as_bytes()), Err(Refusal::Foreign), "{foreign}");
    }
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]
    #[test]
    fn a_written_pose_comes_back(id in 0_u8..100, at in prop::array::uniform3(-9e3..9e3_f64), turn in prop::array::uniform4(-1.0..1.0_f64)) {
        let turn = DQuat::from_array(turn);
        prop_assume!(turn.length() > 0.1);
        let turn = turn.normalize();
        let b = DMat3::from_quat(turn).to_cols_array().map(|b| format!("{b:.6}")).join(" ");
        let line = format!("6d 1 [{id} 1.000][{:.3} {:.3} {:.3} 0 0 0][{b}]", at[0], at[1], at[2]);
        let pose = pose(&line);
        prop_assert!((pose.position_m() - DVec3::from_array(at) * 1e-3).abs().max_element() <= 0.5e-6 + 1e-12);
        // Six digits of nine numbers.
        prop_assert!(pose.rotation().angle_between(turn) < 1e-5 || pose.rotation().angle_between(-turn) < 1e-5);
    }
}
