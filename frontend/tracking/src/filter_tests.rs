//! Laws of the filter.

use super::*;
use crate::noise::Noise;
use glam::DQuat;
use proptest::prelude::*;
use std::f64::consts::TAU;

const POSITION: OneEuro = OneEuro { least_cutoff_hz: 0.5, cutoff_per_speed: 100.0, velocity_cutoff_hz: 1.0 };
const ROTATION: OneEuro = OneEuro { least_cutoff_hz: 0.5, cutoff_per_speed: 16.0, velocity_cutoff_hz: 1.0 };
/// What rounding leaves of a motion of some metres.
const ROUNDING: f64 = 1e-12;
/// A lag that has settled for ten seconds is within this share of the one in theory.
const SETTLED: f64 = 1e-9;

/// Times with uneven intervals, about 100 a second.
fn times(count: usize, noise: &mut Noise) -> Vec<Duration> {
    let step = |at: &mut Duration, _| {
        *at += Duration::from_secs_f64(0.004 + 0.012 * noise.uniform());
        Some(*at)
    };
    (0..count).scan(Duration::ZERO, step).collect()
}

fn turned(position_m: DVec3, turn: DVec3) -> Pose {
    Pose::new(position_m, DQuat::from_scaled_axis(turn)).unwrap()
}

/// How far the filter is behind at the end of an even motion: metres and radians.
fn lag(position: OneEuro, velocity: DVec3, turning: DVec3) -> (f64, f64) {
    let mut filter = PoseFilter::new(position, ROTATION);
    let mut behind = (0.0, 0.0);
    for at in times(1000, &mut Noise(6)) {
        let sample = turned(velocity * at.as_secs_f64(), turning * at.as_secs_f64());
        let found = filter.step(at, sample);
        behind.0 = found.position_m().distance(sample.position_m());
        behind.1 = turn_between(found.rotation(), sample.rotation()).length();
    }
    behind
}

#[test]
fn at_an_even_speed_the_lag_is_the_one_in_theory() {
    let expected = |filter: OneEuro, speed: f64| {
        speed / (TAU * (filter.least_cutoff_hz + filter.cutoff_per_speed * speed))
    };
    for speed in [0.01, 0.2, 3.0] {
        let (velocity, turning) = (DVec3::new(2.0, -1.0, 2.0) * speed / 3.0, DVec3::Y * speed);
        let (lag_m, lag_rad) = lag(POSITION, velocity, turning);
        assert!((lag_m / expected(POSITION, speed) - 1.0).abs() < SETTLED, "{speed}: {lag_m}");
        assert!((lag_rad / expected(ROTATION, speed) - 1.0).abs() < SETTLED, "{speed}: {lag_rad}");
        assert!(lag_m < 1.0 / (TAU * POSITION.cutoff_per_speed), "bounded whatever the speed");
        let stiff = OneEuro { cutoff_per_speed: 0.0, ..POSITION };
        let (canary_m, _) = lag(stiff, velocity, turning);
        assert!((canary_m / expected(POSITION, speed) - 1.0).abs() > SETTLED, "the canary");
    }
}

#[test]
fn a_still_tool_stays_still_to_the_bit() {
    for seed in 0..50 {
        let mut noise = Noise(seed);
        let sample = turned(noise.vector(), 3.0 * noise.vector());
        let mut filter = PoseFilter::new(POSITION, ROTATION);
        for at in times(200, &mut noise) {
            assert_eq!(filter.step(at, sample), sample);
        }
    }
}

/// A filter for each axis, as a spoiled one: its cutoffs depend on which way the axes point.
fn axis_by_axis(samples: &[(Duration, DVec3)]) -> DVec3 {
    let along = |axis: DVec3| {
        let only = |sample: DVec3| turned(axis * sample.dot(axis), DVec3::ZERO);
        let mut filter = PoseFilter::new(POSITION, ROTATION);
        let last = samples.iter().map(|&(at, sample)| filter.step(at, only(sample))).last();
        last.unwrap().position_m()
    };
    along(DVec3::X) + along(DVec3::Y) + along(DVec3::Z)
}

#[test]
fn turning_the_world_turns_the_answer() {
    for seed in 0..20 {
        let mut noise = Noise(seed);
        let times = times(100, &mut noise);
        let world = DQuat::from_scaled_axis(noise.vector());
        let (mut filter, mut in_world) =
            (PoseFilter::new(POSITION, ROTATION), PoseFilter::new(POSITION, ROTATION));
        let (mut place, mut turn, mut places) = (DVec3::ZERO, DVec3::ZERO, Vec::new());
        for &at in &times {
            (place, turn) = (place + 0.01 * noise.vector(), turn + 0.05 * noise.vector());
            places.push((at, place));
            let sample = turned(place, turn);
            let found = filter.step(at, sample);
            let other = Pose::new(world * place, world * sample.rotation()).unwrap();
            let other = in_world.step(at, other);
            assert!(other.position_m().distance(world * found.position_m()) < ROUNDING);
            assert!(turn_between(world * found.rotation(), other.rotation()).length() < ROUNDING);
        }
        let in_world: Vec<_> = places.iter().map(|&(at, place)| (at, world * place)).collect();
        assert!(axis_by_axis(&in_world).distance(world * axis_by_axis(&places)) > ROUNDING, "the canary");
    }
}

#[test]
fn after_a_silence_the_filter_begins_anew() {
    let at = Duration::from_millis;
    let mut filter = PoseFilter::new(POSITION, ROTATION);
    let (here, there) = (turned(DVec3::ZERO, DVec3::ZERO), turned(DVec3::X, DVec3::X));
    filter.step(at(0), here);
    let between = filter.step(at(100), there);
    assert!(between != there && between.position_m().x > 0.0);
    assert_eq!(filter.step(at(201), here), here);
    assert_eq!(filter.step(at(201), there), here, "of the same time");
    assert_eq!(filter.step(at(150), there), here, "earlier");
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]

    #[test]
    fn nothing_makes_it_leave_numbers(samples in prop::collection::vec((0_u64..200_000_000, prop::array::uniform7(
        prop_oneof![-1.0..1.0, -1e6..1e6, Just(0.0), Just(1e6), Just(-1e6), any::<f64>()])), 1..60)) {
        let mut filter = PoseFilter::new(POSITION, ROTATION);
        let mut at = Duration::ZERO;
        for (step_ns, [x, y, z, i, j, k, w]) in samples {
            // Steps of no time, of nanoseconds, and of ordinary lengths.
            at += Duration::from_nanos(if step_ns % 3 == 0 { step_ns % 5 } else { step_ns });
            let Some(sample) = Pose::new(DVec3::new(x, y, z), DQuat::from_xyzw(i, j, k, w)) else { continue };
            let found = filter.step(at, sample);
            prop_assert!(Pose::new(found.position_m(), found.rotation()) == Some(found), "{found:?}");
        }
    }
}
