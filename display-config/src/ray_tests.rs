//! The laws of the ray.

use super::*;
use proptest::prelude::*;

/// Rounding of a few operations on metres, before division by the denominators.
const ROUNDING_M: f64 = 1e-12;

fn projector() -> impl Strategy<Value = DVec3> {
    let z = prop_oneof![-8.0f64..-0.3, 0.3f64..8.0];
    (-4.0f64..4.0, -1.0f64..1.0, z).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn observer() -> impl Strategy<Value = DVec3> {
    (-1.0f64..1.0, -0.5f64..0.5, 0.5f64..6.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn screen() -> impl Strategy<Value = DVec2> {
    (-1.0f64..1.0, -0.5f64..0.5).prop_map(|(x, y)| DVec2::new(x, y))
}

fn eta() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(0.5), Just(1.0), 0.0f64..=1.0]
}

proptest! {
    #![proptest_config(crate::fixed_seed::config())]

    #[test]
    fn each_point_of_a_ray_lands_where_the_ray_crosses(
        e in projector(), v in observer(), s in screen(), eta in eta(), share in 0.01f64..3.0,
    ) {
        let law = BeamLaw::new(e, v, eta).unwrap();
        let ray = law.ray(s);
        // `share` of the way from O to the screen plane; beyond 1 the point is behind the screen.
        let point = ray.at(share * (s.extend(0.0) - ray.origin_in_display).length());
        let denominator = law.b() * (1.0 - share) + share;
        prop_assume!(denominator.abs() > 1e-3);
        let back = law.screen_from_point(point).unwrap();
        let tolerance = ROUNDING_M * (1.0 + law.a().abs() + law.b().abs()) / denominator.abs().min(share);
        prop_assert!((back - s).length() < tolerance, "{back} is not {s}");
    }

    #[test]
    fn rays_start_on_the_observers_line(e in projector(), v in observer(), s in screen(), eta in eta()) {
        let ray = BeamLaw::new(e, v, eta).unwrap().ray(s);
        prop_assert_eq!(ray.origin_in_display.y, v.y);
        prop_assert_eq!(ray.origin_in_display.z, v.z);
        prop_assert!((ray.direction_in_display.length() - 1.0).abs() < 1e-14);
        prop_assert!(ray.direction_in_display.z < 0.0);
    }

    #[test]
    fn eta_zero_is_one_perspective_from_the_observer(e in projector(), v in observer(), s in screen()) {
        let law = BeamLaw::new(e, v, 0.0).unwrap();
        prop_assert_eq!(law.origin(s), v);
        prop_assert_eq!(law.b(), 0.0);
    }

    #[test]
    fn eta_one_follows_the_projectors_beam(e in projector(), v in observer(), s in screen()) {
        let origin = BeamLaw::new(e, v, 1.0).unwrap().origin(s);
        // O, S and E on one line of the x-z plane: the cross product of S − E and O − S is zero.
        let cross = (s.x - e.x) * origin.z - (origin.x - s.x) * -e.z;
        prop_assert!(cross.abs() < 1e-11 * (1.0 + origin.x.abs()), "cross product {cross}");
    }

    #[test]
    fn the_inverse_is_never_nan(
        e in projector(), v in observer(), eta in eta(), q in prop::array::uniform3(prop::num::f64::ANY),
    ) {
        let law = BeamLaw::new(e, v, eta).unwrap();
        if let Ok(screen) = law.screen_from_point(DVec3::from_array(q)) {
            prop_assert!(screen.is_finite());
        }
    }
}

#[test]
fn the_round_trip_notices_a_wrong_law() {
    let (e, v) = (DVec3::new(1.0, 0.0, -6.0), DVec3::new(0.0, 0.0, 3.0));
    let s = DVec2::new(0.3, 0.1);
    let point = BeamLaw::new(e, v, 0.5).unwrap().ray(s).at(2.0);
    let other = BeamLaw::new(e, v, 0.6).unwrap().screen_from_point(point).unwrap();
    assert!((other - s).length() > 1e6 * ROUNDING_M, "the law for another η must land elsewhere");
}

#[test]
fn a_projector_in_the_observers_plane_works() {
    let centre = DVec3::new(0.7, 0.0, 3.0);
    let law = BeamLaw::new(centre, DVec3::new(0.0, 0.1, 3.0), 1.0).unwrap();
    assert_eq!((law.a(), law.b()), (0.7, 0.0));
    let s = DVec2::new(0.3, -0.2);
    let back = law.screen_from_point(law.ray(s).at(1.5)).unwrap();
    assert!((back - s).length() < ROUNDING_M);
}

#[test]
fn senseless_laws_are_named() {
    let (e, v) = (DVec3::new(0.0, 0.0, -6.0), DVec3::new(0.0, 0.0, 3.0));
    assert_eq!(BeamLaw::new(e.with_z(0.0), v, 1.0), Err(RayError::ProjectorInScreenPlane));
    assert_eq!(BeamLaw::new(e, v.with_z(0.0), 1.0), Err(RayError::ObserverBehindScreen { z_m: 0.0 }));
    assert_eq!(BeamLaw::new(e, v, 1.5), Err(RayError::EtaOutOfRange { eta: 1.5 }));
    assert_eq!(BeamLaw::new(e, v, -0.1), Err(RayError::EtaOutOfRange { eta: -0.1 }));
    assert_eq!(BeamLaw::new(e, v, f64::NAN), Err(RayError::NotFinite));
    assert_eq!(BeamLaw::new(e.with_x(f64::INFINITY), v, 1.0), Err(RayError::NotFinite));
    assert_eq!(BeamLaw::new(e.with_z(-1e-320), v, 1.0), Err(RayError::NotFinite));
}

#[test]
fn clips_are_named() {
    let law = BeamLaw::new(DVec3::new(0.5, 0.0, -6.0), DVec3::new(0.0, 0.0, 3.0), 1.0).unwrap();
    assert_eq!(law.screen_from_point(DVec3::new(0.0, 0.0, 3.0)), Err(Clip::BehindObserver));
    assert_eq!(law.screen_from_point(DVec3::new(0.0, 0.0, 4.0)), Err(Clip::BehindObserver));
    // At η = 1 every ray of a row passes through the projector's x and z.
    assert_eq!(law.screen_from_point(DVec3::new(0.5, 0.0, -6.0)), Err(Clip::NoImage));
    assert_eq!(law.screen_from_point(DVec3::NAN), Err(Clip::NotFinite));
}
