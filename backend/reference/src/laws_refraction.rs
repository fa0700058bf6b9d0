//! The laws that light on bent paths must keep.

use super::test_scene::*;
use super::{AnalyticField, Field, Integrator, Radiance, Ray, Reference, Segmentation, StoredField, Tracer};
use bricks::LodRule;
use glam::{DVec3, UVec3};
use optics::{ClipPlane, Curve, Enhancer, Light, Optics, Quality, Ramp};
use protocol::FrameState;

fn refracting(index: &[(f64, f64)], optics: Optics) -> Optics {
    Optics { refraction: Some(Curve::new(index.to_vec()).unwrap()), ..optics }
}

fn fog(per_voxel: f64) -> Optics {
    optics(Curve::constant(per_voxel), Curve::constant(DVec3::splat(0.5)))
}

fn busy() -> Optics {
    let extinction = vec![(0.2, 0.0), (0.3, 0.3), (0.5, 0.02), (0.7, 0.4), (0.8, 0.0)];
    let colours = vec![(0.0, DVec3::X), (0.4, DVec3::Y), (0.7, DVec3::Z), (1.0, DVec3::ONE)];
    optics(Curve::new(extinction).unwrap(), Curve::new(colours).unwrap())
}

fn slab() -> impl Field {
    AnalyticField::new(DVec3::splat(10.0), |p: DVec3| p.x / 10.0, |_| DVec3::X / 10.0)
}

/// A smooth field of 10 voxels with its gradient.
fn smooth() -> impl Field {
    let value = |p: DVec3| noise(0.5 * p);
    let gradient = move |p: DVec3| {
        let h = 1e-4;
        DVec3::from_array(DVec3::AXES.map(|axis| (value(p + h * axis) - value(p - h * axis)) / (2.0 * h)))
    };
    AnalyticField::new(DVec3::splat(10.0), value, gradient).smooth_over(2.0)
}

fn difference(a: &Radiance, b: &Radiance) -> f64 {
    (a.rgb - b.rgb).abs().max_element().max((a.opacity - b.opacity).abs())
}

fn see(optics: Optics, light: Option<Light>, tolerance: f64, field: &dyn Field, ray: &Ray) -> Radiance {
    let integrator = Integrator { tolerance, ..Integrator::default() };
    Tracer::new(&frame(optics, light), integrator).unwrap().radiance_on(field, ray).unwrap()
}

fn slanted() -> Ray {
    Ray::new(DVec3::new(-0.05, 0.03, 0.04), DVec3::new(1.0, 0.25, 0.1))
}

#[test]
fn one_index_shows_the_straight_picture() {
    let field = StoredField::new(FormulaSource::shared(UVec3::splat(40), (0.0, 1.0), noise), &finest());
    let straight = see(busy(), Some(Light::default()), 1e-7, &field, &slanted());
    let bent = see(refracting(&[(0.0, 1.5)], busy()), Some(Light::default()), 1e-7, &field, &slanted());
    assert!(bent.reached && difference(&straight, &bent) < 1e-7, "{straight:?} {bent:?}");
}

#[test]
fn enhancers_know_the_direction_in_which_a_bent_ray_left_the_eye() {
    // What lies beyond the surface at x = 5 is clipped; its context depends on n·v, and v is not that of the chord.
    let plane = ClipPlane {
        point_in_display: DVec3::X * 0.05,
        normal_in_display: DVec3::X,
        context: Ramp { low: -1.0, high: 3.0 },
        thickness_m: 0.0,
        boost: 1.0,
        strength: 1.0,
    };
    let clipped = |optics: Optics| Optics { enhancers: vec![Enhancer::ClipPlane(plane)], ..optics };
    let seen = see(clipped(refracting(&[(0.5, 1.0), (0.5, 1.5)], fog(0.1))), None, 1e-9, &slab(), &slanted());
    let v = slanted().direction_in_display;
    let across = DVec3::new(0.0, v.y, v.z) / 1.5;
    // n·v > 0, so 1 − max(0, −n·v) is 1: half way up the ramp.
    let length = 5.0 / v.x + 0.5 * 5.0 / (1.0 - across.length_squared()).sqrt();
    assert!(seen.reached && (seen.opacity + (-0.1 * length).exp_m1()).abs() < 1e-9, "{seen:?}");
    let back = ClipPlane { normal_in_display: DVec3::NEG_X, ..plane };
    let clipped = |optics: Optics| Optics { enhancers: vec![Enhancer::ClipPlane(back)], ..optics };
    let seen = see(clipped(refracting(&[(0.5, 1.0), (0.5, 1.5)], fog(0.1))), None, 1e-9, &slab(), &slanted());
    let context = back.context.at(1.0 - v.x);
    let length = context * 5.0 / v.x + 5.0 / (1.0 - across.length_squared()).sqrt();
    assert!(seen.reached && (seen.opacity + (-0.1 * length).exp_m1()).abs() < 1e-9, "{seen:?}");
    // One index, and all the same.
    let straight = see(clipped(busy()), Some(Light::default()), 1e-7, &smooth(), &slanted());
    let bent =
        see(clipped(refracting(&[(0.0, 1.5)], busy())), Some(Light::default()), 1e-7, &smooth(), &slanted());
    assert!(difference(&straight, &bent) < 1e-7, "{straight:?} {bent:?}");
}

#[test]
fn fog_beyond_a_surface_is_as_thick_as_the_bent_way_is_long() {
    let seen = see(refracting(&[(0.5, 1.0), (0.5, 1.5)], fog(0.1)), None, 1e-9, &slab(), &slanted());
    let v = slanted().direction_in_display;
    let across = DVec3::new(0.0, v.y, v.z) / 1.5;
    let length = 5.0 / v.x + 5.0 / (1.0 - across.length_squared()).sqrt();
    assert!(seen.reached && (seen.opacity + (-0.1 * length).exp_m1()).abs() < 1e-9, "{seen:?}");
}

#[test]
fn parts_of_a_bent_way_composite_to_the_whole() {
    let tracer = |tolerance: f64| {
        let integrator = Integrator { tolerance, ..Integrator::default() };
        Tracer::new(&frame(refracting(&[(0.0, 1.0), (1.0, 1.4)], busy()), None), integrator).unwrap()
    };
    let part = |from: f64, to: f64| tracer(1e-7).radiance_within(&smooth(), &slanted(), (from, to)).unwrap();
    let (whole, cut) = (part(0.0, f64::INFINITY), 0.1);
    assert!(difference(&part(0.0, cut).over(part(cut, f64::INFINITY)), &whole) < 3e-7);
    assert!(part(0.0, cut).opacity > 0.01 && part(cut, f64::INFINITY).opacity > 0.01);
}

#[test]
fn the_error_stays_below_the_tolerance() {
    let model = || refracting(&[(0.0, 1.0), (0.4, 1.1), (1.0, 1.4)], busy());
    let truth = see(model(), Some(Light::default()), 1e-10, &smooth(), &slanted());
    assert!(truth.reached && truth.opacity > 0.2, "{truth:?}");
    let straight = see(busy(), Some(Light::default()), 1e-7, &smooth(), &slanted());
    assert!(difference(&straight, &truth) > 1e-3);
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
        let start = std::time::Instant::now();
        let seen = see(model(), Some(Light::default()), tolerance, &smooth(), &slanted());
        let error = difference(&seen, &truth);
        println!("tolerance {tolerance:e}: error {error:e}, {:?}, {seen:?}", start.elapsed());
        assert!(seen.reached && error <= tolerance, "{tolerance:e}: {error:e} {seen:?}");
    }
}

#[test]
fn a_tolerance_out_of_reach_is_admitted() {
    let integrator = Integrator { tolerance: 1e-14, max_depth: 2 };
    let model = refracting(&[(0.0, 1.0), (1.0, 1.4)], busy());
    let tracer = Tracer::new(&frame(model, None), integrator).unwrap();
    assert!(!tracer.radiance_within(&smooth(), &slanted(), (0.0, 0.06)).unwrap().reached);
}

#[test]
fn segments_of_a_bent_ray_are_refused_in_words() {
    let tracer = tracer(refracting(&[(0.0, 1.5)], fog(0.1)), 1e-5);
    let segments = Segmentation::uniform(0.0, 1.0, 4).unwrap();
    let refused = tracer.segmented_on(&slab(), &slanted(), &segments).unwrap_err();
    assert!(refused.to_string().contains("refraction"), "{refused}");
}

#[test]
fn stored_samples_of_all_kinds_stay_numbers() {
    let source = FormulaSource::shared(UVec3::splat(60), (0.0, 1.0), |p| noise(0.3 * p));
    let rule = LodRule { lod_scale: 20.0, ..finest() };
    for quadrilinear in [false, true] {
        for index in
            [&[(0.0, 1.0), (1.0, 1.3)][..], &[(0.5, 1.0), (0.5, 1.4)], &[(0.3, 1.5), (0.5, 1.0), (0.5, 1.6)]]
        {
            let quality = Quality { quadrilinear, ..Quality::default() };
            let frame = FrameState { quality, ..frame(refracting(index, busy()), Some(Light::default())) };
            let reference = Reference::new(
                source.clone(),
                &frame,
                &rule,
                Integrator { tolerance: 1e-4, ..Integrator::default() },
            )
            .unwrap();
            for height in [0.1, 0.2, 0.3] {
                let start = std::time::Instant::now();
                let seen =
                    reference.radiance(DVec3::new(-0.1, height, 0.3), DVec3::new(1.0, 0.1, -0.05)).unwrap();
                println!("{quadrilinear} {index:?}: {:?} {seen:?}", start.elapsed());
                assert!(seen.rgb.is_finite() && (0.0..=1.0).contains(&seen.opacity));
            }
        }
    }
}
