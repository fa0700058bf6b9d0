//! Laws of registration.

use super::eigen::symmetric_eigen;
use super::*;
use crate::noise::Noise;
use glam::{DMat3, DQuat};
use proptest::prelude::*;
use std::f64::consts::PI;

/// What rounding may leave of a transform that fits exactly, metres and radians.
const EXACT: f64 = 1e-12;
/// Of Monte Carlo estimates with 2000 trials, as a share: four standard deviations are 0.063.
const SAMPLED: f64 = 0.08;
const TRIALS: u32 = 2000;

fn named(points: impl IntoIterator<Item = (DVec3, DVec3)>) -> Vec<PointPair> {
    let pair = |(at, (point_in_tracker, point_in_display))| PointPair {
        name: format!("p{at}"),
        point_in_tracker,
        point_in_display,
    };
    points.into_iter().enumerate().map(pair).collect()
}

/// Points in and before a screen of 1.6 × 0.9 m.
fn marks(count: usize, noise: &mut Noise) -> Vec<DVec3> {
    let mut within = |size: f64| size * (noise.uniform() - 0.5);
    (0..count).map(|_| DVec3::new(within(1.6), within(0.9), within(0.8) + 0.4)).collect()
}

/// The pairs that a tracker measures with an error of `noise_m` along each axis.
fn measured(marks: &[DVec3], truth: &RigidTransform, noise_m: f64, noise: &mut Noise) -> Vec<PointPair> {
    let inverse = truth.rotation.inverse();
    let pair = |&mark: &DVec3| (inverse * (mark - truth.translation_m) + noise_m * noise.vector(), mark);
    named(marks.iter().map(pair))
}

fn turn_between(a: DQuat, b: DQuat) -> DVec3 {
    let turn = a * b.inverse();
    2.0 * turn.xyz() * turn.w.signum()
}

fn some_truth() -> RigidTransform {
    RigidTransform {
        rotation: DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -2.0) / 3.0, 2.1),
        translation_m: DVec3::new(0.4, -1.1, 2.0),
    }
}

fn refused(pairs: &[PointPair]) -> RegistrationError {
    register(pairs).unwrap_err()
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]

    #[test]
    fn a_known_transform_is_recovered(seed: u64, count in 3_usize..40, angle in prop_oneof![Just(PI), Just(0.0), 0.0..PI]) {
        let mut noise = Noise(seed);
        let axis = noise.vector().normalize();
        let truth = RigidTransform {
            rotation: DQuat::from_axis_angle(axis, angle),
            translation_m: noise.vector(),
        };
        let pairs = measured(&marks(count, &mut noise), &truth, 0.0, &mut noise);
        // Few random points may happen to lie nearly on a line.
        if let Ok(found) = register(&pairs) {
            prop_assert!(turn_between(found.display_from_tracker.rotation, truth.rotation).length() < EXACT);
            prop_assert!(found.display_from_tracker.translation_m.distance(truth.translation_m) < EXACT);
            prop_assert!(found.rms_m < EXACT && (found.scale - 1.0).abs() < EXACT);
        } else {
            let is_slender = matches!(refused(&pairs), RegistrationError::Collinear { .. });
            prop_assert!(is_slender, "{}", refused(&pairs));
        }
    }

    #[test]
    fn nothing_panics_and_nothing_is_nan(numbers in prop::collection::vec(
        prop_oneof![-2.0..2.0, Just(0.0), Just(f64::NAN), Just(f64::INFINITY), any::<f64>()], 0..60)) {
        let points = numbers.chunks_exact(6).map(|n| (DVec3::from_slice(n), DVec3::from_slice(&n[3..])));
        match register(&named(points)) {
            Ok(found) => {
                let RigidTransform { rotation, translation_m } = found.display_from_tracker;
                prop_assert!(rotation.is_normalized() && translation_m.is_finite());
                prop_assert!(found.rms_m <= MOST_RMS_M && found.error_at_m(DVec3::ONE).is_finite());
            }
            Err(error) => prop_assert!(!error.to_string().contains("NaN"), "{error}"),
        }
    }
}

#[test]
fn the_error_falls_with_the_root_of_the_number_of_pairs() {
    const NOISE_M: f64 = 0.001;
    let mut noise = Noise(3);
    let target = DVec3::new(0.3, 0.2, 1.0);
    let truth = some_truth();
    let mut root_counts = Vec::new();
    for count in [8, 32, 128] {
        // The same places again and again, so that the shape stays.
        let places = marks(8, &mut Noise(5)).repeat(count / 8);
        let mut squares = 0.0;
        for _ in 0..TRIALS {
            let pairs = measured(&places, &truth, NOISE_M, &mut noise);
            let found = Fit::of(&pairs.iter().collect::<Vec<_>>()).display_from_tracker;
            let in_tracker = truth.rotation.inverse() * (target - truth.translation_m);
            squares += found.point(in_tracker).distance_squared(target);
        }
        root_counts.push((squares / f64::from(TRIALS)).sqrt() * (count as f64).sqrt());
    }
    for pair in root_counts.windows(2) {
        assert!((pair[1] / pair[0] - 1.0).abs() < SAMPLED, "{root_counts:?}");
    }
}

#[test]
fn the_expected_error_is_the_one_that_comes() {
    const NOISE_M: f64 = 0.002;
    let (mut noise, truth) = (Noise(8), some_truth());
    let places = marks(10, &mut noise);
    for target in [DVec3::ZERO, DVec3::new(0.0, 0.0, 3.0), DVec3::new(1.5, 0.0, 3.0)] {
        let in_tracker = truth.rotation.inverse() * (target - truth.translation_m);
        let (mut squares, mut expected_squares) = (0.0, 0.0);
        for _ in 0..TRIALS {
            let found = register(&measured(&places, &truth, NOISE_M, &mut noise)).unwrap();
            squares += found.display_from_tracker.point(in_tracker).distance_squared(target);
            expected_squares += found.error_at_m(target).powi(2);
        }
        let ratio = (squares / expected_squares).sqrt();
        assert!((ratio - 1.0).abs() < SAMPLED, "{target}: {ratio}");
    }
}

#[test]
fn no_rotation_is_biased() {
    const NOISE_M: f64 = 0.002;
    let mut noise = Noise(21);
    let half_turns = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE.normalize()].map(|axis| (axis, PI));
    for (axis, angle) in half_turns.into_iter().chain([(DVec3::Y, 0.0), (DVec3::X, 1.3)]) {
        let rotation = DQuat::from_axis_angle(axis, angle);
        let truth = RigidTransform { rotation, translation_m: DVec3::new(0.5, -0.2, 1.0) };
        let (mut sum, mut squares) = (DVec3::ZERO, 0.0);
        let places = marks(6, &mut Noise(2));
        for _ in 0..TRIALS {
            let found = register(&measured(&places, &truth, NOISE_M, &mut noise)).unwrap();
            let turn = turn_between(found.display_from_tracker.rotation, rotation);
            sum += turn;
            squares += turn.length_squared();
        }
        // The length of a mean of independent errors is their RMS over the root of their number; seldom thrice that.
        let trials = f64::from(TRIALS);
        assert!(sum.length() / trials < 3.0 * (squares / trials / trials).sqrt(), "{rotation}: {sum}");
    }
}

/// The orthogonal matrix nearest to the pairs' covariance, mirroring or not: Kabsch's method without its guard.
fn unguarded(pairs: &[PointPair]) -> DMat3 {
    let centroid =
        |point: fn(&PointPair) -> DVec3| pairs.iter().map(point).sum::<DVec3>() / pairs.len() as f64;
    let (a0, b0) = (centroid(|pair| pair.point_in_tracker), centroid(|pair| pair.point_in_display));
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(b * a.x, b * a.y, b * a.z);
    let sum =
        |sum: DMat3, pair: &PointPair| sum + outer(pair.point_in_tracker - a0, pair.point_in_display - b0);
    let covariance = pairs.iter().fold(DMat3::ZERO, sum);
    let squared = (covariance.transpose() * covariance).to_cols_array_2d();
    let inverse_root = symmetric_eigen(squared).iter().fold(DMat3::ZERO, |root, (value, vector)| {
        let axis = DVec3::from_array(*vector);
        root + outer(axis, axis) * value.sqrt().recip()
    });
    covariance * inverse_root
}

#[test]
fn a_mirrored_tracker_is_refused_and_an_unguarded_kabsch_takes_it() {
    let mut noise = Noise(13);
    let mut pairs = measured(&marks(8, &mut noise), &some_truth(), 0.001, &mut noise);
    assert!((unguarded(&pairs).determinant() - 1.0).abs() < 1e-9);
    assert_eq!(register(&pairs).unwrap().handedness, Handedness::Right);
    pairs.iter_mut().for_each(|pair| pair.point_in_tracker.z *= -1.0);
    assert!((unguarded(&pairs).determinant() + 1.0).abs() < 1e-9, "the canary mirrors");
    let RegistrationError::LeftHanded { rms_m, mirrored_rms_m } = refused(&pairs) else {
        panic!("{}", refused(&pairs))
    };
    assert!(mirrored_rms_m < 0.003 && rms_m > 0.2, "{rms_m} {mirrored_rms_m}");
}

#[test]
fn points_of_a_plane_do_not_tell_which_hand_it_is() {
    let mut noise = Noise(34);
    let flat: Vec<DVec3> = marks(8, &mut noise).iter().map(|mark| mark.with_z(0.0)).collect();
    for noise_m in [0.0, 0.001] {
        let mut pairs = measured(&flat, &some_truth(), noise_m, &mut noise);
        assert_eq!(register(&pairs).unwrap().handedness, Handedness::Unclear);
        pairs.iter_mut().for_each(|pair| pair.point_in_tracker.x *= -1.0);
        assert_eq!(register(&pairs).unwrap().handedness, Handedness::Unclear, "{noise_m}");
    }
}

#[test]
fn a_mark_may_be_measured_several_times() {
    let mut noise = Noise(55);
    let places = marks(3, &mut noise).repeat(5);
    let found = register(&measured(&places, &some_truth(), 0.001, &mut noise)).unwrap();
    assert!(found.rms_m < 0.003 && found.residuals_m.len() == 15);
}

#[test]
fn pairs_that_are_grossly_wrong_are_named() {
    for (count, wrong) in [(4, 1), (5, 1), (8, 1), (8, 2), (12, 3)] {
        let mut noise = Noise(89 + count as u64);
        let mut pairs = measured(&marks(count, &mut noise), &some_truth(), 0.0005, &mut noise);
        // All to the same side, so that they hide each other.
        pairs[1..=wrong].iter_mut().for_each(|pair| pair.point_in_tracker.x += 0.5);
        let RegistrationError::Outliers { mut outliers, rms_without_m } = refused(&pairs) else {
            panic!("{count}, {wrong}: {}", refused(&pairs))
        };
        outliers.sort_by(|a, b| a.name.cmp(&b.name));
        let names: Vec<_> = outliers.iter().map(|outlier| outlier.name.clone()).collect();
        assert_eq!(names, (1..=wrong).map(|at| format!("p{at}")).collect::<Vec<_>>());
        assert!(rms_without_m < 0.002 && outliers.iter().all(|o| (o.distance_m - 0.5).abs() < 0.02));
    }
}

#[test]
fn noise_makes_no_outliers() {
    let mut noise = Noise(144);
    for trial in 0..TRIALS {
        let count = 4 + trial as usize % 9;
        let pairs = measured(&marks(count, &mut noise), &some_truth(), 0.002, &mut noise);
        let is_fair = !matches!(register(&pairs), Err(RegistrationError::Outliers { .. }));
        assert!(is_fair, "{}", refused(&pairs));
    }
}

#[test]
fn what_cannot_be_registered_is_refused_in_a_sentence() {
    let mut noise = Noise(233);
    let good = measured(&marks(6, &mut noise), &some_truth(), 0.0005, &mut noise);
    let spoiled = |spoil: &dyn Fn(usize, &mut PointPair)| {
        let mut pairs = good.clone();
        pairs.iter_mut().enumerate().for_each(|(at, pair)| spoil(at, pair));
        refused(&pairs).to_string()
    };
    let on_line = |at: usize, off: f64| DVec3::new(0.3 * at as f64, if at == 2 { off } else { 0.0 }, 0.0);
    for (sentence, part) in [
        (refused(&good[..2]).to_string(), "2 point pairs do not fix a rotation"),
        (refused(&vec![good.clone(); 40].concat()).to_string(), "240 point pairs are too many"),
        (
            refused(&[good.clone(), good.clone()].concat()).to_string(),
            "`p0` and `p0` have the same tracker point",
        ),
        (
            spoiled(&|at, pair| pair.point_in_display.y = if at == 4 { f64::NAN } else { 0.0 }),
            "pair `p4` has a coordinate in the display frame",
        ),
        (
            spoiled(&|at, pair| pair.point_in_display = on_line(at, 0.0)),
            "in the display frame all points lie",
        ),
        (
            spoiled(&|at, pair| pair.point_in_tracker = on_line(at, 0.03)),
            "in the tracker frame all points lie",
        ),
        (spoiled(&|_, pair| pair.point_in_tracker *= 1e3), "the tracker seems to speak millimetres"),
        (spoiled(&|_, pair| pair.point_in_display *= 100.0), "display_m seems to be in centimetres"),
        (spoiled(&|_, pair| pair.point_in_tracker *= 7.0), "they are in different units"),
        (
            spoiled(&|at, pair| pair.point_in_display = good[(at + 3) % 6].point_in_display),
            "the pairs do not fit together",
        ),
        (spoiled(&|at, pair| pair.point_in_display.x += if at == 3 { 0.4 } else { 0.0 }), "pair `p3` is 0.4"),
    ] {
        assert!(sentence.contains(part), "{sentence}");
    }
}

#[test]
fn a_scale_that_is_a_little_off_is_reported() {
    let mut noise = Noise(377);
    let mut pairs = measured(&marks(8, &mut noise), &some_truth(), 0.0, &mut noise);
    pairs.iter_mut().for_each(|pair| pair.point_in_tracker *= 1.01);
    let found = register(&pairs).unwrap();
    assert!((found.scale * 1.01 - 1.0).abs() < EXACT && found.rms_m > 0.001);
}
