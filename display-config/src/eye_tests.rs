//! The laws of the eye's weights.

use super::*;
use proptest::prelude::*;

/// Rounding of a sum of a few weights.
const ROUNDING: f64 = 1e-9;

/// The weights of one screen point for one eye.
fn eye_weights(
    display: &Display,
    screen: DVec2,
    eye_in_display: DVec3,
) -> Result<Vec<(usize, f64)>, RayError> {
    Ok(EyeModel::new(display, eye_in_display)?.weights(screen))
}

fn holo72() -> Display {
    Display::load("holo72").unwrap()
}

/// An eye in holo72's viewing zone, at distances from 3 to 5 m.
fn eye_in_zone() -> impl Strategy<Value = DVec3> {
    (-0.59f64..0.59, -0.3f64..0.3, 3.0f64..5.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn on_screen() -> impl Strategy<Value = DVec2> {
    (-0.8f64..=0.8, -0.45f64..=0.45).prop_map(|(x, y)| DVec2::new(x, y))
}

fn direction_of(display: &Display, projector: usize, screen: DVec2) -> f64 {
    let centre = display.projectors[projector].centre_in_display;
    ((screen.x - centre.x) / -centre.z).atan()
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]

    #[test]
    fn in_the_zone_weights_interpolate_the_eyes_direction(eye in eye_in_zone(), screen in on_screen()) {
        // Beams farther apart than Φ: two hats sum to 1 before any normalising, so the mean direction is the eye's own.
        let mut display = holo72();
        display.angular_accuracy = 0.1f64.to_radians();
        let weights = eye_weights(&display, screen, eye).unwrap();
        prop_assert!((1..=2).contains(&weights.len()));
        let mean: f64 = weights.iter().map(|&(p, w)| w * direction_of(&display, p, screen)).sum();
        let direction = ((eye.x - screen.x) / eye.z).atan();
        prop_assert!((mean - direction).abs() < ROUNDING, "{mean} is not {direction}");
    }

    #[test]
    fn weights_sum_to_one_in_order(eye in eye_in_zone(), screen in on_screen(), accuracy in 0.001f64..0.3) {
        let mut display = holo72();
        display.angular_accuracy = accuracy;
        let weights = eye_weights(&display, screen, eye).unwrap();
        prop_assert!((weights.iter().map(|&(_, w)| w).sum::<f64>() - 1.0).abs() < ROUNDING);
        prop_assert!(weights.iter().all(|&(_, w)| w > 0.0));
        prop_assert!(weights.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn weights_are_continuous_in_the_eye(
        eye in eye_in_zone(), screen in on_screen(), accuracy in 0.001f64..0.3, seed in 0u32..1000,
    ) {
        // Unevenly placed projectors, so that spacings on both sides of a beam differ.
        let mut display = holo72();
        display.angular_accuracy = accuracy;
        for (i, projector) in (seed..).zip(&mut display.projectors) {
            projector.centre_in_display.x += 0.04 * f64::from(i * 7919 % 101) / 101.0;
        }
        let dense = |eye| {
            let mut dense = vec![0.0; 72];
            for (p, w) in eye_weights(&display, screen, eye).unwrap() {
                dense[p] = w;
            }
            dense
        };
        let step_m = 1e-7;
        // No lobe is narrower than Φ ≥ 0.001 rad, so no weight changes faster than some 1000 per radian, and normalising
        // a few lobes at most doubles it.
        let most = 4000.0 * step_m / eye.z;
        for (a, b) in dense(eye).iter().zip(dense(eye + DVec3::X * step_m)) {
            prop_assert!((a - b).abs() < most, "{a} jumps to {b}");
        }
    }
}

#[test]
fn an_eye_on_a_beam_sees_that_projector_alone() {
    let display = holo72();
    let screen = DVec2::new(0.1, 0.2);
    let centre = display.projectors[30].centre_in_display;
    let slope = (screen.x - centre.x) / -centre.z;
    let eye = DVec3::new(screen.x + 3.0 * slope, 0.0, 3.0);
    let weights = eye_weights(&display, screen, eye).unwrap();
    let of_30 = weights.iter().find(|&&(projector, _)| projector == 30).unwrap().1;
    assert!((of_30 - 1.0).abs() < ROUNDING);
}

#[test]
fn far_outside_the_fan_no_beam_reaches_the_eye() {
    let display = holo72();
    assert_eq!(eye_weights(&display, DVec2::ZERO, DVec3::new(9.0, 0.0, 3.0)).unwrap(), []);
}

#[test]
fn only_rasters_that_cover_the_point_count() {
    let mut display = Display::load("desk8").unwrap();
    let (first, last) = (display.projectors[0].clone(), display.projectors[7].clone());
    let right_half = crate::Homography::of_rectangle(
        first.raster.size(),
        DVec2::new(0.0, -display.height_m / 2.0),
        DVec2::new(display.width_m / 2.0, display.height_m),
    );
    for projector in &mut display.projectors[1..7] {
        projector.raster.screen_from_pixel = right_half;
    }
    let indices = |screen: DVec2| -> Vec<usize> {
        eye_weights(&display, screen, DVec3::new(0.0, 0.0, 1.2)).unwrap().iter().map(|&(p, _)| p).collect()
    };
    assert!(first.centre_in_display.x < last.centre_in_display.x);
    assert_eq!(indices(DVec2::new(-0.1, 0.0)), [0, 7]);
    assert!(indices(DVec2::new(0.1, 0.0)).iter().all(|p| (1..7).contains(p)));
}

#[test]
fn coincident_projectors_share_alike() {
    let mut display = holo72();
    let eye = DVec3::new(0.21, 0.0, 3.0);
    let single = eye_weights(&display, DVec2::ZERO, eye).unwrap();
    let twins = display.projectors.clone();
    display.projectors.extend(twins);
    let double = eye_weights(&display, DVec2::ZERO, eye).unwrap();
    assert_eq!(double.len(), 2 * single.len());
    for (projector, weight) in single {
        for twin in [projector, projector + 72] {
            let found = double.iter().find(|&&(p, _)| p == twin).unwrap().1;
            assert!((found - weight / 2.0).abs() < ROUNDING);
        }
    }
}

#[test]
fn a_single_projector_is_seen_within_the_angular_accuracy() {
    let mut display = Display::load("desk8").unwrap();
    display.projectors.truncate(1);
    let centre = display.projectors[0].centre_in_display;
    let on_beam = DVec3::new(-centre.x * 1.2 / -centre.z, 0.0, 1.2);
    assert_eq!(eye_weights(&display, DVec2::ZERO, on_beam).unwrap(), [(0, 1.0)]);
    assert_eq!(eye_weights(&display, DVec2::ZERO, on_beam - DVec3::X).unwrap(), []);
}

#[test]
fn an_eye_behind_the_screen_is_refused() {
    let display = holo72();
    let refusal = |z| EyeModel::new(&display, DVec3::new(0.0, 0.0, z)).unwrap_err();
    assert_eq!(refusal(0.0), RayError::EyeBehindScreen { z_m: 0.0 });
    assert_eq!(refusal(-1.0), RayError::EyeBehindScreen { z_m: -1.0 });
    assert_eq!(refusal(f64::NAN), RayError::NotFinite);
}

#[test]
fn an_eye_outside_the_zone_is_told_so() {
    let display = holo72();
    let sentence = |x, z| EyeModel::new(&display, DVec3::new(x, 0.0, z)).unwrap().outside_zone();
    assert_eq!(sentence(0.5, 3.0), None);
    let aside = sentence(0.7, 3.0).unwrap();
    assert!(aside.contains("x = 0.70 m") && aside.contains("from -0.60 to 0.60 m"), "{aside}");
    assert!(sentence(0.0, 1.0).unwrap().contains("no viewing zone"));
}
