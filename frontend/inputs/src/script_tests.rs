//! Tests of scripts.

use super::*;
use crate::Pose;

fn script(text: &str) -> Result<Script, String> {
    toml::from_str::<RawScript>(text).map_err(|error| error.to_string()).and_then(Script::try_from)
}

const PATH: &str = "rate_hz = 10
[[step]]
at_s = 0.0
pose = { sensor = 2, position_m = [0.0, 0.0, 0.0] }
[[step]]
at_s = 0.5
button = { index = 1, is_down = true }
[[step]]
at_s = 1.0
pose = { sensor = 2, position_m = [1.0, 0.0, 2.0], orientation = [0.0, 1.0, 0.0, 0.0] }
[[step]]
at_s = 1.0
lost = 2
";

fn polled(running: &mut Running, now_ms: u64) -> Vec<(u128, What)> {
    let mut all = Vec::new();
    running.poll(Duration::from_millis(now_ms), |received, _, what| all.push((received.as_millis(), what)));
    all
}

#[test]
fn a_path_goes_straight_and_turns_evenly() {
    let mut running = Running::new(script(PATH).unwrap());
    let all = polled(&mut running, 7000);
    assert_eq!(all.len(), 1, "the first question is the beginning");
    let all = polled(&mut running, 8000);
    let poses: Vec<(u128, Option<Pose>)> = all
        .iter()
        .filter_map(|(at, what)| match what {
            What::Pose { sensor: 2, pose } => Some((*at, *pose)),
            _ => None,
        })
        .collect();
    assert_eq!(
        poses.iter().map(|pose| pose.0).collect::<Vec<_>>(),
        (7100..=8000).step_by(100).collect::<Vec<_>>()
    );
    let half = poses[4].1.unwrap();
    assert!((half.position_m() - DVec3::new(0.5, 0.0, 1.0)).length() < 1e-12);
    assert!(half.rotation().angle_between(DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2)) < 1e-6);
    assert_eq!(poses[9].1, None, "the last step wins");
    assert!(all.contains(&(7500, What::Button { index: 1, is_down: true })));
    assert_eq!(polled(&mut running, 20_000), [], "it is over");
}

#[test]
fn a_repeated_path_gives_the_same_however_often_it_is_asked() {
    let text = format!("repeat = true\n{}", PATH.replace("at_s = 1.0\nlost", "at_s = 1.5\nlost"));
    let mut seldom = Running::new(script(&text).unwrap());
    let mut often = Running::new(script(&text).unwrap());
    let by_seldom: Vec<_> = [0, 5000].into_iter().flat_map(|now| polled(&mut seldom, now)).collect();
    let by_often: Vec<_> = (0..=500).flat_map(|now| polled(&mut often, 10 * now)).collect();
    assert!(by_seldom.len() > 30);
    assert_eq!(by_seldom, by_often);
}

#[test]
fn who_asks_once_a_day_gets_no_flood() {
    let mut running = Running::new(script(&format!("repeat = true\n{PATH}")).unwrap());
    polled(&mut running, 0);
    assert!(polled(&mut running, 86_400_000).len() <= 4 * MOST_TICKS as usize);
}

#[test]
fn mistakes_are_named() {
    for (text, sentence) in [
        ("rate_hz = 0\nstep = []", "`rate_hz` is 0; give a number from 1 to 1000"),
        ("repeat = true\nstep = []", "it repeats and takes no time"),
        ("[[step]]\nat_s = nan\nlost = 1", "`at_s` of step 1 is NaN"),
        ("[[step]]\nat_s = 2\nlost = 1\n[[step]]\nat_s = 1\nlost = 1", "`at_s` of step 2 is 1"),
        ("[[step]]\nat_s = 0", "step 1: give one of `pose`, `lost`, `button` and `axis`"),
        ("[[step]]\nat_s = 0\nlost = 1\naxis = { index = 0, value = 0 }", "step 1: give one of"),
        ("[[step]]\nat_s = 0\naxis = { index = 0, value = inf }", "step 1: it has an infinite number or NaN"),
        (
            "[[step]]\nat_s = 0\npose = { sensor = 0, position_m = [0, 0, 0], orientation = [0, 0, 0, 0] }",
            "no length",
        ),
        ("[[step]]\nat_s = 0\nlose = 1", "unknown field `lose`"),
    ] {
        let error = script(text).unwrap_err();
        assert!(error.contains(sentence), "{text}: {error}");
    }
}
