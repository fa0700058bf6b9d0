//! Laws of a tool's track.

use super::*;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

fn there(x_m: f64) -> Option<Pose> {
    Pose::new(DVec3::X * x_m, DQuat::from_rotation_z(x_m))
}

/// A tool that has rested at x = 1 m for some milliseconds, 125 samples a second.
fn resting(until_ms: u64) -> ToolTrack {
    let mut track = ToolTrack::new(TrackSettings::default());
    (0..=until_ms).step_by(8).for_each(|at| track.push(ms(at), there(1.0)));
    track
}

fn presence(track: &ToolTrack, now_ms: u64) -> f64 {
    track.at(ms(now_ms), ms(now_ms + 40)).map_or(0.0, |tracked| tracked.presence)
}

#[test]
fn a_tool_that_nobody_has_seen_is_not_there() {
    let mut track = ToolTrack::new(TrackSettings::default());
    assert_eq!(track.at(ms(0), ms(10)), None);
    track.push(ms(5), None);
    assert_eq!(track.at(ms(10), ms(20)), None);
    assert_eq!(track.counts(), SampleCounts { lost: 1, ..SampleCounts::default() });
}

#[test]
fn a_still_tool_is_shown_where_it_is_to_the_bit() {
    let track = resting(800);
    assert_eq!(track.at(ms(810), ms(850)), Some(Tracked { pose: there(1.0).unwrap(), presence: 1.0 }));
}

#[test]
fn a_lost_tool_is_held_and_fades_and_comes_back_from_what_is_left() {
    let mut track = resting(800);
    assert_eq!([presence(&track, 800), presence(&track, 1300)], [1.0, 1.0]);
    assert_eq!([presence(&track, 1450), presence(&track, 1600)], [0.5, 0.0]);
    track.push(ms(1400), None);
    track.push(ms(1450), there(2.0));
    assert_eq!(presence(&track, 1450), 0.5);
    assert_eq!(track.at(ms(1450), ms(1490)).unwrap().pose, there(2.0).unwrap(), "at once where it is");
    assert_eq!(presence(&track, 1600), 1.0);
}

#[test]
fn a_tool_fades_in_when_it_is_first_seen() {
    let mut track = resting(0);
    assert_eq!([presence(&track, 0), presence(&track, 150)], [0.0, 0.5]);
    track.push(ms(150), there(1.0));
    assert_eq!([presence(&track, 150), presence(&track, 300)], [0.5, 1.0]);
}

#[test]
fn samples_that_come_too_late_are_counted_and_change_nothing() {
    let mut track = resting(800);
    let before = track.clone();
    track.push(ms(800), there(9.0));
    track.push(ms(793), there(9.0));
    track.push(ms(0), None);
    assert_eq!((track.counts().duplicate, track.counts().late), (1, 2));
    track.counts = before.counts;
    assert_eq!(track, before);
}

#[test]
fn a_clock_that_is_set_back_begins_a_new_track() {
    let mut track = resting(4000);
    track.push(ms(100), there(5.0));
    assert_eq!(track.counts().restarts, 1);
    let shown = track.at(ms(110), ms(150)).unwrap();
    assert_eq!((shown.pose, shown.presence), (there(5.0).unwrap(), 1.0));
    // A sample of the far future neither keeps the tool there for ever nor keeps others out.
    track.push(Duration::MAX, there(7.0));
    assert_eq!(track.at(ms(150), ms(190)), None);
    track.push(ms(150), there(5.0));
    assert!(track.counts().restarts == 2 && track.at(ms(300), ms(340)).is_some());
}

#[test]
fn at_an_even_speed_the_tool_is_behind_by_the_filter_s_lag_alone() {
    let settings = TrackSettings::default();
    let (speed, position) = (0.4, settings.position);
    let mut track = ToolTrack::new(settings);
    let place = |at_ms: u64| Pose::new(DVec3::X * speed * 1e-3 * at_ms as f64, DQuat::IDENTITY);
    (0..=8000).step_by(8).for_each(|at| track.push(ms(at), place(at)));
    let lag_m = speed / (TAU * (position.least_cutoff_hz + position.cutoff_per_speed * speed));
    for seen_ms in [8000, 8030, 8060] {
        let shown_m = track.at(ms(8000), ms(seen_ms)).unwrap().pose.position_m();
        let error_m = shown_m.distance(place(seen_ms).unwrap().position_m());
        assert!((error_m - lag_m).abs() < 1e-9, "{seen_ms}: {error_m}");
    }
}

#[test]
fn both_signs_of_quaternions_make_the_same_track() {
    let mut tracks = [1.0, -1.0].map(|_| ToolTrack::new(TrackSettings::default()));
    for at in 0..300_u64 {
        // Whole turns, through both signs of w.
        let turn = DQuat::from_rotation_y(0.1 * at as f64) * DQuat::from_rotation_x(0.02 * at as f64);
        for (track, sign) in tracks.iter_mut().zip([1.0, if at % 3 == 0 { -1.0 } else { 1.0 }]) {
            track.push(ms(8 * at), Pose::new(DVec3::Z, turn * sign));
        }
    }
    assert_eq!(tracks[0], tracks[1]);
}

/// A sample by its numbers: no step, a step of nanoseconds, an ordinary one, a silence, or one back.
fn step(at: Duration, step: u64) -> Duration {
    match step % 8 {
        0 => at,
        1 => at + Duration::from_nanos(step % 100),
        2 => at + ms(step % 2000),
        3 => at.saturating_sub(ms(step % 3000)),
        _ => at + ms(step % 20),
    }
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]

    #[test]
    fn answers_are_poses_and_questions_change_nothing(samples in prop::collection::vec((any::<u64>(), prop::array::uniform7(
        prop_oneof![-1.0..1.0, -1e6..1e6, Just(0.0), Just(1e6), any::<f64>()])), 1..60)) {
        let mut asked = ToolTrack::new(TrackSettings::default());
        let (mut unasked, mut at) = (asked.clone(), Duration::ZERO);
        for (time, [x, y, z, i, j, k, w]) in samples {
            at = step(at, time);
            let sample = Pose::new(DVec3::new(x, y, z), DQuat::from_xyzw(i, j, k, w));
            asked.push(at, sample);
            unasked.push(at, sample);
            if let Some(Tracked { pose, presence }) = asked.at(at + ms(time % 700), at + ms(time % 900)) {
                prop_assert!(Pose::new(pose.position_m(), pose.rotation()) == Some(pose), "{pose:?}");
                prop_assert!(presence > 0.0 && presence <= 1.0);
            }
        }
        prop_assert_eq!(&asked, &unasked);
        prop_assert_eq!(asked.at(at, at + ms(30)), unasked.at(at, at + ms(30)));
    }
}
