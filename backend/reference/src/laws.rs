//! The laws that the integrator must keep.

use super::test_scene::*;
use super::{AnalyticField, Field, Integrator, Radiance, Ray, Reference, Segmentation, StoredField, Tracer};
use glam::{DVec3, UVec3};
use optics::{Curve, Light, MimdaForm, Optics};

/// Rounding, in numbers of order one over a few hundred pieces.
const ROUNDING: f64 = 1e-12;
/// Tolerance of the tests that compare two integrations.
const TIGHT: f64 = 1e-9;

fn grey(value: f64) -> Curve<DVec3> {
    Curve::constant(DVec3::splat(value))
}

fn ramp() -> Curve<f64> {
    Curve::new(vec![(0.0, 0.0), (1.0, 1.0)]).unwrap()
}

fn colours() -> Curve<DVec3> {
    Curve::new(vec![(0.0, DVec3::X), (0.4, DVec3::Y), (0.7, DVec3::Z), (1.0, DVec3::ONE)]).unwrap()
}

fn busy_optics() -> Optics {
    let extinction = vec![(0.2, 0.0), (0.3, 0.5), (0.5, 0.02), (0.6, 0.02), (0.6, 0.9), (0.8, 0.0)];
    optics(Curve::new(extinction).unwrap(), colours())
}

/// A field that depends on x alone, 10 voxels long, with the exact gradient left out.
fn along_x(f: impl Fn(f64) -> f64 + Send + Sync) -> impl Field {
    AnalyticField::new(DVec3::splat(10.0), move |p: DVec3| f(p.x), |_| DVec3::ZERO)
}

fn x_ray() -> Ray {
    Ray::new(DVec3::new(-0.1, 0.05, 0.05), DVec3::X)
}

fn oblique() -> Ray {
    Ray::new(DVec3::new(-0.2, 0.03, 0.11), DVec3::new(1.0, 0.31, 0.17))
}

fn assert_close(a: Radiance, b: Radiance, within: f64) {
    let distance = (a.rgb - b.rgb).abs().max_element().max((a.opacity - b.opacity).abs());
    assert!(distance <= within, "{a:?} against {b:?}: {distance:e}");
}

fn noisy_store(edge: u32) -> StoredField {
    StoredField::new(FormulaSource::shared(UVec3::splat(edge), (0.0, 1.0), noise), &finest())
}

#[test]
fn a_constant_medium_follows_beer_and_lambert() {
    let colour = DVec3::new(0.9, 0.5, 0.1);
    for depth in [1e-8, 1e-4, 0.1, 1.0, 30.0, 1e4] {
        let tracer = tracer(optics(Curve::constant(depth / 10.0), Curve::constant(colour)), 1e-13);
        let seen = tracer.radiance_on(&along_x(|_| 0.5), &x_ray()).unwrap();
        let exact = -(-depth).exp_m1();
        assert!((seen.opacity / exact - 1.0).abs() < ROUNDING, "{depth}: {seen:?}");
        assert!(((seen.rgb / (colour * exact)) - 1.0).abs().max_element() < ROUNDING, "{depth}: {seen:?}");
        assert!(seen.reached);
    }
}

#[test]
fn a_linear_ramp_has_its_closed_form() {
    // τ = 0.2 s per voxel, s = x / 10: the depth is 1. With c = s the colour is ∫ s d(1 − e^(−D)), D = s².
    let tracer = tracer(
        optics(
            Curve::new(vec![(0.0, 0.0), (1.0, 0.2)]).unwrap(),
            Curve::new(vec![(0.0, DVec3::ZERO), (1.0, DVec3::ONE)]).unwrap(),
        ),
        TIGHT,
    );
    let seen = tracer.radiance_on(&along_x(|x| x / 10.0), &x_ray()).unwrap();
    // ∫₀¹ 2 s² e^(−s²) ds = √π/2 · erf(1) − e⁻¹.
    let colour = 0.746_824_132_812_427 - (-1.0_f64).exp();
    assert!((seen.opacity - (1.0 - (-1.0_f64).exp())).abs() < ROUNDING);
    assert!((seen.rgb.x - colour).abs() < TIGHT, "{seen:?}");
}

#[test]
fn a_spike_of_one_ten_thousandth_is_not_missed() {
    let spike = Curve::new(vec![(0.5, 0.0), (0.50005, 2e4), (0.5001, 0.0)]).unwrap();
    let tracer = tracer(optics(spike, grey(1.0)), 1e-5);
    // The spike's area is 1; s changes by 0.1 per voxel, so the depth is 10.
    let exact = -(-10.0_f64).exp_m1();
    let seen = tracer.radiance_on(&along_x(|x| x / 10.0), &x_ray()).unwrap();
    assert!((seen.opacity - exact).abs() < 1e-9, "{seen:?}");
    let source = FormulaSource::shared(UVec3::new(40, 4, 4), (0.0, 1.0), |p| (p.x / 40.0).clamp(0.0, 1.0));
    let stored = StoredField::new(source, &finest());
    let seen = tracer.radiance_on(&stored, &Ray::new(DVec3::new(-0.1, 0.02, 0.02), DVec3::X)).unwrap();
    assert!((seen.opacity - -(-40.0_f64).exp_m1()).abs() < 1e-9, "{seen:?}");
}

#[test]
fn two_halves_composite_to_the_whole() {
    let (field, tracer) = (noisy_store(40), tracer(busy_optics(), TIGHT));
    let whole = tracer.radiance_on(&field, &oblique()).unwrap();
    for cut in [0.21, 0.3, 0.4567] {
        let front = tracer.radiance_within(&field, &oblique(), (0.0, cut)).unwrap();
        let back = tracer.radiance_within(&field, &oblique(), (cut, f64::INFINITY)).unwrap();
        assert_close(front.over(back), whole, 3.0 * TIGHT);
    }
}

#[test]
fn gamma_zero_is_emission_and_absorption_to_the_bit() {
    let field = noisy_store(40);
    let plain = tracer(busy_optics(), 1e-6).radiance_on(&field, &oblique()).unwrap();
    for form in [MimdaForm::Paper, MimdaForm::Consistent] {
        let gamma_zero = tracer(with_importance(busy_optics(), ramp(), 0.0, form), 1e-6);
        assert_eq!(gamma_zero.radiance_on(&field, &oblique()).unwrap(), plain);
    }
}

/// An opaque-ish slab at low s, then a clear rise to s = 1: what the rise keeps of the slab.
fn kept_by_a_clear_rise(gamma: f64, top: f64, form: MimdaForm) -> f64 {
    let extinction = Curve::new(vec![(0.0, 0.0), (0.1, 1.0), (0.2, 0.0)]).unwrap();
    let importance = Curve::new(vec![(0.3, 0.0), (0.9, top)]).unwrap();
    let plain = optics(extinction, grey(1.0));
    let field = along_x(|x| 0.5 - 0.5 * (0.1 * std::f64::consts::PI * x).cos());
    let before = tracer(plain.clone(), TIGHT).radiance_on(&field, &x_ray()).unwrap();
    let after =
        tracer(with_importance(plain, importance, gamma, form), TIGHT).radiance_on(&field, &x_ray()).unwrap();
    assert!((after.rgb.x / before.rgb.x - after.opacity / before.opacity).abs() < ROUNDING);
    after.opacity / before.opacity
}

#[test]
fn a_clear_rise_from_zero_to_b_keeps_what_each_form_says() {
    for (gamma, top) in [(0.5, 1.0), (1.0, 0.7), (0.3, 0.2), (1.0, 1.0)] {
        let consistent = kept_by_a_clear_rise(gamma, top, MimdaForm::Consistent);
        assert!((consistent - (1.0 - gamma * top)).abs() < ROUNDING, "{consistent}");
        let paper = kept_by_a_clear_rise(gamma, top, MimdaForm::Paper);
        assert!((paper - (-gamma * top).exp()).abs() < ROUNDING, "{paper}");
    }
}

/// One number per form: opacity after a medium of constant extinction in which ι rises linearly from 0 to `top`.
fn through_a_rise(depth: f64, gamma: f64, top: f64, form: MimdaForm) -> Radiance {
    let importance = Curve::new(vec![(0.0, 0.0), (1.0, top)]).unwrap();
    let model = with_importance(optics(Curve::constant(depth / 10.0), grey(0.5)), importance, gamma, form);
    tracer(model, 1e-7).radiance_on(&along_x(|x| x / 10.0), &x_ray()).unwrap()
}

#[test]
fn a_rise_within_a_medium_solves_its_differential_equation() {
    for depth in [1e-6_f64, 0.3, 4.0, 1e3, 1e7] {
        // Paper: dA/dx = τ − (τ + γ b) A with constants, so A = τ / (τ + γ b) · (1 − exp(−(τ + γ b))).
        let rate: f64 = depth + 0.8 * 0.9;
        let exact = depth / rate * -(-rate).exp_m1();
        let seen = through_a_rise(depth, 0.8, 0.9, MimdaForm::Paper);
        assert!((seen.opacity - exact).abs() < 1e-7, "{depth}: {seen:?} {exact}");
        assert!((seen.rgb.x - 0.5 * exact).abs() < 1e-7 && seen.reached, "{depth}: {seen:?}");
        // Consistent, γ b = q: with y = A / (1 − q x), dy/dx = τ / (1 − q x) − τ y: compare with a fine midpoint sum.
        let seen = through_a_rise(depth, 1.0, 0.9, MimdaForm::Consistent);
        let n = 400_000;
        let term = |i: i32| {
            let x = (f64::from(i) + 0.5) / f64::from(n);
            depth * (-depth * (1.0 - x)).exp() * 0.1 / (1.0 - 0.9 * x) / f64::from(n)
        };
        let exact: f64 = (0..n).map(term).sum();
        if depth < 1e4 {
            assert!((seen.opacity - exact).abs() < 1e-6 && seen.reached, "{depth}: {seen:?} {exact}");
        }
    }
}

#[test]
fn full_importance_at_gamma_one_erases_all_before_it() {
    let seen = through_a_rise(3.0, 1.0, 1.0, MimdaForm::Consistent);
    assert_eq!((seen.rgb, seen.opacity), (DVec3::ZERO, 0.0));
    let nearly = through_a_rise(3.0, 1.0, 1.0 - 1e-9, MimdaForm::Consistent);
    assert!(nearly.opacity < 1e-6 && nearly.reached, "{nearly:?}");
}

#[test]
fn an_importance_jump_is_the_limit_of_steep_flanks() {
    let field = noisy_store(40);
    let seen = |width: f64, form| {
        let importance = Curve::new(vec![(0.55 - width, 0.1), (0.55, 0.8)]).unwrap();
        tracer(with_importance(busy_optics(), importance, 0.9, form), TIGHT)
            .radiance_on(&field, &oblique())
            .unwrap()
    };
    for form in [MimdaForm::Paper, MimdaForm::Consistent] {
        let jump = seen(0.0, form);
        assert_close(seen(1e-6, form), jump, 1e-5);
        assert_close(seen(1e-9, form), jump, 1e-7);
    }
}

#[test]
fn the_error_falls_with_the_tolerance_and_stays_below_it() {
    let field = noisy_store(40);
    let model = || with_importance(busy_optics(), ramp(), 0.7, MimdaForm::Consistent);
    let light = Some(Light::default());
    let at = |tolerance: f64| {
        let integrator = Integrator { tolerance, ..Integrator::default() };
        Tracer::new(&frame(model(), light), integrator).unwrap().radiance_on(&field, &oblique()).unwrap()
    };
    let truth = at(1e-12);
    let mut last = f64::INFINITY;
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-8] {
        let seen = at(tolerance);
        let error = (seen.rgb - truth.rgb).abs().max_element().max((seen.opacity - truth.opacity).abs());
        assert!(
            seen.reached && seen.error_estimate <= tolerance && error <= tolerance,
            "{tolerance}: {error:e}"
        );
        assert!(error <= last.max(0.01 * tolerance), "{tolerance}: {error:e} after {last:e}");
        last = error;
    }
}

#[test]
fn a_depth_limit_is_admitted() {
    let integrator = Integrator { tolerance: 1e-12, max_depth: 0 };
    let tracer = Tracer::new(&frame(busy_optics(), Some(Light::default())), integrator).unwrap();
    assert!(!tracer.radiance_on(&noisy_store(40), &oblique()).unwrap().reached);
}

#[test]
fn stored_samples_of_a_linear_field_are_that_field() {
    let dims = DVec3::new(70.0, 33.0, 20.0);
    let slope = DVec3::new(0.006, -0.004, 0.01);
    // Samples stop half a voxel before the faces and repeat beyond.
    let formula = move |p: DVec3| 0.3 + slope.dot(p.clamp(DVec3::splat(0.5), dims - 0.5));
    let source = FormulaSource::shared(dims.as_uvec3(), (0.0, 1.0), formula);
    let stored = StoredField::new(source, &finest());
    let analytic = AnalyticField::new(dims, formula, move |_| slope).smooth_over(1.0);
    let light = Some(Light::default());
    let tracer = Tracer::new(&frame(busy_optics(), light), Integrator::default()).unwrap();
    // Inside, away from the faces, gradients agree too. Quantisation to 16 bits is what separates them.
    let within = (0.23, 0.5);
    let ray = Ray::new(DVec3::new(-0.2, 0.1, 0.08), DVec3::new(1.0, 0.1, 0.05));
    let a = tracer.radiance_within(&stored, &ray, within).unwrap();
    let b = tracer.radiance_within(&analytic, &ray, within).unwrap();
    assert!(a.opacity > 0.5);
    assert_close(a, b, 1e-3);
    let p = DVec3::new(27.9, 16.2, 9.7);
    assert!((stored.value(p).unwrap() - formula(p)).abs() < 1e-5);
    assert!((stored.gradient(p).unwrap() - slope).abs().max_element() < 1e-5);
}

#[test]
fn a_light_leaves_a_zero_gradient_alone_and_shades_others() {
    let model = || busy_optics();
    let field = along_x(noise_in_x);
    let integrator = Integrator::default();
    let plain = Tracer::new(&frame(model(), None), integrator).unwrap();
    let lit = Tracer::new(&frame(model(), Some(Light::default())), integrator).unwrap();
    let (a, b) = (plain.radiance_on(&field, &x_ray()).unwrap(), lit.radiance_on(&field, &x_ray()).unwrap());
    assert_close(a, b, 1e-5);
    let sloped = AnalyticField::new(DVec3::splat(10.0), |p: DVec3| noise_in_x(p.x), |_| DVec3::X * 0.1);
    let c = lit.radiance_on(&sloped, &x_ray()).unwrap();
    assert!((c.rgb - a.rgb).abs().max_element() > 0.01 && (c.opacity - a.opacity).abs() < ROUNDING);
}

fn noise_in_x(x: f64) -> f64 {
    noise(DVec3::new(x, 0.0, 0.0))
}

#[test]
fn the_shading_law_is_the_documented_one() {
    // A constant gradient of s along x, seen along x, lit from above: n·l = 0.6, h = normalize(l − v).
    let light = Light { toward_light_in_display: DVec3::new(0.6, 0.8, 0.0), ..Light::default() };
    let model = optics(Curve::constant(0.1), grey(0.5));
    let tracer = Tracer::new(&frame(model, Some(light)), Integrator::default()).unwrap();
    let field = AnalyticField::new(DVec3::splat(10.0), |_| 0.5, |_| DVec3::new(0.02, 0.0, 0.0));
    let seen = tracer.radiance_on(&field, &x_ray()).unwrap();
    let half = (light.toward_light_in_display - DVec3::X).normalize();
    let highlight = light.specular * half.x.abs().powf(light.shininess);
    let colour = 0.5 * (0.5 + 0.5 * (light.ambient + light.diffuse * 0.6)) + 0.5 * highlight;
    assert!((seen.rgb.x - colour * seen.opacity).abs() < 1e-5, "{seen:?} {colour}");
}

#[test]
fn the_front_colour_dominates() {
    let jump = Curve::new(vec![(0.5, DVec3::X), (0.5, DVec3::Z)]).unwrap();
    let tracer = tracer(optics(Curve::constant(1.0), jump), 1e-5);
    let field = along_x(|x| x / 10.0);
    let front = tracer.radiance_on(&field, &x_ray()).unwrap();
    let back = tracer.radiance_on(&field, &Ray::new(DVec3::new(0.3, 0.05, 0.05), DVec3::NEG_X)).unwrap();
    // Red fills the first half of the way, at depth 5.
    assert!((front.rgb.x - -(-5.0_f64).exp_m1()).abs() < 1e-5);
    assert!((back.rgb.z - front.rgb.x).abs() < 1e-5 && (back.rgb.x - front.rgb.z).abs() < 1e-5);
}

#[test]
fn awkward_rays_see_numbers_and_mirror_rays_see_the_same_depth() {
    let source = FormulaSource::shared(UVec3::new(57, 29, 56), (0.0, 1.0), noise);
    let stored = StoredField::new(source, &finest());
    let far = DVec3::new(0.57, 0.29, 0.56);
    let model = with_importance(busy_optics(), ramp(), 1.0, MimdaForm::Consistent);
    let awkward = Tracer::new(&frame(model, Some(Light::default())), Integrator::default()).unwrap();
    let coordinates = [0.0, 0.005, 0.28, 0.29, 0.56, 0.57, 0.28 + 1e-8, 0.281];
    let directions = [
        DVec3::X,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::ONE,
        DVec3::new(1.0, -1.0, 0.0),
        DVec3::new(1.0, 1e-9, -1e-9),
    ];
    for x in coordinates {
        for y in coordinates {
            for direction in directions {
                // One from inside (or the surface), one from outside through the same point.
                let point = DVec3::new(x, y, 0.28);
                for origin in [point, point - direction, point - direction * 0.28] {
                    let seen = awkward.radiance_on(&stored, &Ray::new(origin, direction)).unwrap();
                    assert!(
                        seen.rgb.is_finite() && (0.0..=1.0).contains(&seen.opacity),
                        "{origin} {direction}"
                    );
                }
                let plain = tracer(busy_optics(), TIGHT);
                let there =
                    plain.radiance_on(&stored, &Ray::new(point - 2.0 * direction, direction)).unwrap();
                let back =
                    plain.radiance_on(&stored, &Ray::new(point + 2.0 * direction, -direction)).unwrap();
                assert!((there.opacity - back.opacity).abs() < 3.0 * TIGHT, "{point} {direction}");
            }
        }
    }
    let nothing = awkward.radiance_on(&stored, &Ray::new(far * 2.0, DVec3::ONE)).unwrap();
    assert_eq!(
        (nothing, awkward.radiance_on(&stored, &Ray::new(far * 0.5, DVec3::ZERO)).unwrap()),
        (Radiance::NOTHING, Radiance::NOTHING)
    );
}

#[test]
fn published_segments_do_not_matter_without_importance_and_creep_to_the_limit_with_it() {
    let field = noisy_store(40);
    let plain = tracer(busy_optics(), TIGHT);
    let whole = plain.radiance_on(&field, &oblique()).unwrap();
    let segments = |n| Segmentation::uniform(0.0, 1.0, n).unwrap();
    assert_close(plain.segmented_on(&field, &oblique(), &segments(37)).unwrap(), whole, 10.0 * TIGHT);
    let paper = tracer(with_importance(busy_optics(), ramp(), 1.0, MimdaForm::Paper), TIGHT);
    let limit = paper.radiance_on(&field, &oblique()).unwrap();
    let miss =
        |n| (paper.segmented_on(&field, &oblique(), &segments(n)).unwrap().opacity - limit.opacity).abs();
    let (coarse, fine) = (miss(500), miss(16_000));
    assert!(fine < coarse && fine < 2e-3, "{coarse:e} {fine:e}");
}

#[test]
fn one_published_step_keeps_one_minus_gamma_delta() {
    let extinction = Curve::new(vec![(0.0, 1.0), (0.5, 1.0), (0.5, 0.0)]).unwrap();
    let importance = Curve::new(vec![(0.5, 0.0), (0.5, 0.6)]).unwrap();
    let model = with_importance(optics(extinction, grey(1.0)), importance, 0.9, MimdaForm::Paper);
    let field = along_x(|x| x / 10.0);
    // Two segments that meet where the importance jumps, at x = 5: t = 0.15.
    let halves = Segmentation::new(vec![0.1, 0.15, 0.2]).unwrap();
    let slab = -(-5.0_f64).exp_m1();
    let stepped = tracer(model.clone(), TIGHT).segmented_on(&field, &x_ray(), &halves).unwrap();
    assert!((stepped.opacity - slab * (1.0 - 0.9 * 0.6)).abs() < 1e-9, "{stepped:?}");
    let continuous = tracer(model, TIGHT).radiance_on(&field, &x_ray()).unwrap();
    assert!((continuous.opacity - slab * (-0.9_f64 * 0.6).exp()).abs() < 1e-9, "{continuous:?}");
}

#[test]
fn coarser_leaves_are_used_where_the_rule_allows_them() {
    let source = FormulaSource::shared(UVec3::splat(80), (0.0, 1.0), |p| (p.z / 80.0).clamp(0.0, 1.0));
    // One centimetre a voxel; at |z| = 0.8 m the display resolves 2 cm, at the screen 1 cm.
    let rule = bricks::LodRule { pixel_size_m: 0.01, angular_accuracy: 0.0125, lod_scale: 1.0, ..finest() };
    let stored = StoredField::new(source.clone(), &rule);
    // A coarse sample centre lies at 2 i + 1 finest voxels; nodes beyond 0.8 m do not exist here, so only scale 4 does it.
    let coarse = StoredField::new(source, &bricks::LodRule { lod_scale: 4.0, ..rule });
    let p = DVec3::new(40.0, 40.0, 0.9);
    assert!((stored.value(p).unwrap() - 0.9 / 80.0).abs() < 1e-5);
    assert!((coarse.value(p).unwrap() - 2.0 / 80.0).abs() < 1e-5, "clamped below the first coarse centre");
    assert!((coarse.gradient(DVec3::splat(40.0)).unwrap().z - 1.0 / 80.0).abs() < 1e-6);
}

#[test]
fn a_reference_is_its_tracer_over_its_store() {
    let source = FormulaSource::shared(UVec3::splat(30), (0.0, 1.0), noise);
    let frame = frame(busy_optics(), None);
    let reference = Reference::new(source, &frame, &finest(), Integrator::default()).unwrap();
    let ray = oblique();
    let seen = reference.radiance(ray.origin_in_display, ray.direction_in_display).unwrap();
    assert_eq!(seen, reference.tracer().radiance_on(reference.field(), &ray).unwrap());
    let bad = Integrator { tolerance: 0.0, ..Integrator::default() };
    assert!(Tracer::new(&frame, bad).is_err());
}
