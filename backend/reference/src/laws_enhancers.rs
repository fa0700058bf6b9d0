//! The laws that a chain of enhancers must keep.

use super::test_scene::*;
use super::{AnalyticField, Field, Integrator, Radiance, Ray, StoredField, Tracer};
use glam::{DVec3, UVec3};
use optics::{
    BandPicker, ClipPlane, Curve, Enhancer, LayerOpacity, Light, MimdaForm, Optics, Probe, Ramp, Trapezoid,
};

/// Tolerance of the tests that compare with a closed form.
const TIGHT: f64 = 1e-9;
/// Rounding, in numbers of order one over a few hundred pieces.
const ROUNDING: f64 = 1e-12;
/// A ramp that is 1 for all that faces the tool at all.
const ALWAYS: Ramp = Ramp { low: -2.0, high: -1.0 };
/// A ramp that is 0 for all.
const NEVER: Ramp = Ramp { low: 2.0, high: 3.0 };

fn plane(x_m: f64) -> ClipPlane {
    ClipPlane {
        point_in_display: DVec3::new(x_m, 0.0, 0.0),
        normal_in_display: DVec3::NEG_X,
        context: NEVER,
        thickness_m: 0.0,
        boost: 1.0,
        strength: 1.0,
    }
}

fn layer(band: [f64; 4], factor: f64) -> Enhancer {
    Enhancer::LayerOpacity(LayerOpacity {
        band: Trapezoid::new(band).unwrap(),
        axis_in_display: DVec3::X,
        facing: ALWAYS,
        away: 0.0,
        toward: factor,
    })
}

fn picker(band: [f64; 4], strength: f64) -> Enhancer {
    let band = Trapezoid::new(band).unwrap();
    Enhancer::BandPicker(BandPicker { band, axis_in_display: DVec3::X, facing: ALWAYS, strength })
}

fn probe(centre: DVec3, radius_m: f64) -> Probe {
    Probe {
        centre_in_display: centre,
        radius_m,
        axis_in_display: DVec3::X,
        facing: ALWAYS,
        gradient_most: 0.2,
        edges: Ramp { low: 0.0, high: 1.0 },
        strength: 1.0,
    }
}

fn with(optics: Optics, enhancers: &[Enhancer]) -> Optics {
    Optics { enhancers: enhancers.to_vec(), ..optics }
}

/// Constant extinction per voxel, grey.
fn fog(per_voxel: f64) -> Optics {
    optics(Curve::constant(per_voxel), Curve::constant(DVec3::splat(0.5)))
}

/// A field that depends on x alone, 10 voxels long.
fn along_x(f: impl Fn(f64) -> f64 + Send + Sync) -> impl Field {
    AnalyticField::new(DVec3::splat(10.0), move |p: DVec3| f(p.x), |_| DVec3::ZERO)
}

fn x_ray() -> Ray {
    Ray::new(DVec3::new(-0.1, 0.05, 0.05), DVec3::X)
}

fn seen(optics: Optics, tolerance: f64, field: &dyn Field, ray: &Ray) -> Radiance {
    let seen = tracer(optics, tolerance).radiance_on(field, ray).unwrap();
    assert!(seen.reached && seen.rgb.is_finite(), "{seen:?}");
    seen
}

fn assert_close(a: Radiance, b: Radiance, within: f64) {
    let distance = difference(&a, &b);
    assert!(distance <= within, "{a:?} against {b:?}: {distance:e}");
}

fn difference(a: &Radiance, b: &Radiance) -> f64 {
    (a.rgb - b.rgb).abs().max_element().max((a.opacity - b.opacity).abs())
}

fn busy() -> Optics {
    let extinction = vec![(0.2, 0.0), (0.3, 0.5), (0.5, 0.02), (0.6, 0.02), (0.6, 0.9), (0.8, 0.0)];
    let colours = vec![(0.0, DVec3::X), (0.4, DVec3::Y), (0.7, DVec3::Z), (1.0, DVec3::ONE)];
    optics(Curve::new(extinction).unwrap(), Curve::new(colours).unwrap())
}

fn busy_with_importance(gamma: f64) -> Optics {
    let ramp = Curve::new(vec![(0.0, 0.0), (1.0, 1.0)]).unwrap();
    with_importance(busy(), ramp, gamma, MimdaForm::Consistent)
}

fn noisy_store(edge: u32) -> StoredField {
    StoredField::new(FormulaSource::shared(UVec3::splat(edge), (0.0, 1.0), noise), &finest())
}

fn oblique() -> Ray {
    Ray::new(DVec3::new(-0.2, 0.03, 0.11), DVec3::new(1.0, 0.31, 0.17))
}

/// All four in the middle of a volume of 40 voxels, three at a time.
fn chains() -> [[Enhancer; 3]; 2] {
    let sliced =
        ClipPlane { thickness_m: 0.07, boost: 3.0, context: Ramp { low: 0.0, high: 1.5 }, ..plane(0.15) };
    let probe = Enhancer::Probe(probe(DVec3::splat(0.2), 0.15));
    let (picker, layer) = (picker([0.2, 0.4, 0.4, 0.6], 0.8), layer([0.3, 0.5, 0.6, 0.6], 2.0));
    [[Enhancer::ClipPlane(sliced), picker, probe], [layer, probe, picker]]
}

#[test]
fn neutral_enhancers_are_none() {
    let idle_plane = ClipPlane { strength: 0.0, thickness_m: 0.1, boost: 5.0, ..plane(0.1) };
    let idle_probe = Probe { strength: 0.0, ..probe(DVec3::splat(0.2), 0.1) };
    let one = layer([0.1, 0.3, 0.5, 0.9], 1.0);
    let chain = [Enhancer::ClipPlane(idle_plane), Enhancer::Probe(idle_probe), one];
    let field = noisy_store(40);
    for model in [busy(), busy_with_importance(0.7)] {
        let none = seen(model.clone(), TIGHT, &field, &oblique());
        assert_close(seen(with(model.clone(), &chain), TIGHT, &field, &oblique()), none, 2.0 * TIGHT);
        let idle = [picker([0.2, 0.3, 0.4, 0.5], 0.0)];
        assert_close(seen(with(model, &idle), TIGHT, &field, &oblique()), none, 2.0 * TIGHT);
    }
}

#[test]
fn a_clip_plane_across_fog_has_its_closed_form() {
    // The ray runs from x = 0 to 0.1; all before x = 0.03 is cut away, 0.04 behind it is emphasised.
    let cut = |context, strength| Enhancer::ClipPlane(ClipPlane { context, strength, ..plane(0.03) });
    let opacity = |enhancer| seen(with(fog(0.2), &[enhancer]), TIGHT, &along_x(|_| 0.5), &x_ray()).opacity;
    assert!((opacity(cut(NEVER, 1.0)) + (-0.2 * 7.0_f64).exp_m1()).abs() < ROUNDING);
    // Looking straight at the plane, 1 − max(0, −n·v) is 0: half way up this ramp.
    let half = Ramp { low: -1.0, high: 1.0 };
    assert!((opacity(cut(half, 1.0)) + (-0.2 * 8.5_f64).exp_m1()).abs() < TIGHT);
    assert!((opacity(cut(NEVER, 0.5)) + (-0.2 * 8.5_f64).exp_m1()).abs() < TIGHT);
    // 1/y² − 2 + 2y is 3 at y = 1/2, and its integral from there to y = 1 is 3/4.
    let sliced = ClipPlane { thickness_m: 0.04, boost: 3.0, ..plane(0.03) };
    let exact = -(-0.2 * (3.0 + 4.0 * (0.5 * 3.0 + 0.75_f64))).exp_m1();
    assert!((opacity(Enhancer::ClipPlane(sliced)) - exact).abs() < TIGHT);
}

#[test]
fn whatever_a_plane_slices_is_opaque_in_the_colour_that_it_has_there() {
    let ramp = Curve::new(vec![(0.0, DVec3::X), (1.0, DVec3::Y)]).unwrap();
    let sliced = ClipPlane { thickness_m: 0.04, boost: ClipPlane::OPAQUE, ..plane(0.03) };
    for (per_voxel, within) in [(2e-3, 1e-3), (0.2, 1e-4), (20.0, 1e-6)] {
        let model = optics(Curve::constant(per_voxel), ramp.clone());
        // The plane lies at x = 3 voxels, where s = 0.3.
        let slice =
            seen(with(model, &[Enhancer::ClipPlane(sliced)]), TIGHT, &along_x(|x| x / 10.0), &x_ray());
        assert!(slice.opacity > 1.0 - within, "{per_voxel}: {slice:?}");
        // Of the thinnest, light comes from a tenth of a voxel behind it.
        assert!((slice.rgb - DVec3::new(0.7, 0.3, 0.0)).length() < 10.0 * within, "{per_voxel}: {slice:?}");
    }
    // Where there is nothing there is nothing to see.
    let model = with(fog(0.0), &[Enhancer::ClipPlane(sliced)]);
    assert_eq!(seen(model, TIGHT, &along_x(|_| 0.5), &x_ray()).opacity, 0.0);
}

#[test]
fn a_layer_scales_its_extinction() {
    for (factor, depth) in [(0.3, 2.0), (4.0, 0.5), (0.0, 3.0), (2.0, 1e-7), (0.5, 1e7)] {
        let model = with(fog(depth / 10.0), &[layer([0.4, 0.4, 0.6, 0.6], factor)]);
        for value in [0.5, 0.4, 0.6] {
            let opacity = seen(model.clone(), TIGHT, &along_x(|_| value), &x_ray()).opacity;
            let exact = -(-factor * depth).exp_m1();
            assert!((opacity - exact).abs() < TIGHT, "{value}: {opacity} {exact}");
        }
        let beside = seen(model, TIGHT, &along_x(|_| 0.7), &x_ray());
        assert!((beside.opacity + (-depth).exp_m1()).abs() < ROUNDING);
    }
}

#[test]
fn a_triangular_layer_on_a_ramp_has_its_closed_form() {
    // b is a triangle of area 1/2 over the whole way: ∫ 1 + b (μ − 1) = (1 + μ) / 2.
    let model = with(fog(0.1), &[layer([0.0, 0.5, 0.5, 1.0], 5.0)]);
    let opacity = seen(model, TIGHT, &along_x(|x| x / 10.0), &x_ray()).opacity;
    assert!((opacity + (-3.0_f64).exp_m1()).abs() < TIGHT);
}

#[test]
fn order_matters_to_a_probe_after_a_picker_alone() {
    let sloped =
        AnalyticField::new(DVec3::splat(10.0), |p: DVec3| p.x / 10.0, |_| DVec3::new(0.01, 0.1, 0.0));
    let probe = Enhancer::Probe(probe(DVec3::splat(0.05), 0.04));
    let picker = picker([0.0, 0.3, 0.5, 1.0], 0.5);
    let ramp = Curve::new(vec![(0.0, 0.2), (1.0, 1.0)]).unwrap();
    let model = with_importance(fog(0.2), ramp, 0.5, MimdaForm::Consistent);
    let see = |chain: &[Enhancer]| seen(with(model.clone(), chain), TIGHT, &sloped, &x_ray());
    assert!(difference(&see(&[probe, picker]), &see(&[picker, probe])) > 1e-3);
    let (cut, layer) = (Enhancer::ClipPlane(plane(0.03)), layer([0.2, 0.4, 0.6, 0.8], 3.0));
    assert_close(see(&[cut, layer]), see(&[layer, cut]), 2.0 * TIGHT);
}

#[test]
fn a_probe_does_not_see_the_sign_of_a_gradient_and_opens_where_there_is_none() {
    let sphere = probe(DVec3::splat(0.05), 0.03);
    let model = with(fog(0.2), &[Enhancer::Probe(sphere)]);
    let see = |gradient: DVec3| {
        seen(
            model.clone(),
            TIGHT,
            &AnalyticField::new(DVec3::splat(10.0), |_| 0.5, move |_| gradient),
            &x_ray(),
        )
    };
    let gradient = DVec3::new(0.02, 0.1, -0.07);
    assert_eq!(see(gradient), see(-gradient));
    // g = 0: μ is 0 in the front half and 1 − ω_d = (q/r)² in the back one: ∫₀³ (q/3)² dq = 1 voxel.
    let open = see(DVec3::ZERO);
    assert!((open.opacity + (-0.2 * (4.0 + 1.0_f64)).exp_m1()).abs() < TIGHT, "{open:?}");
    // A silhouette of full strength: η = 1, so τ is ω_d in front, 1 behind; k is 0 in front, (q/r)² behind.
    let silhouette = see(DVec3::Y);
    assert!((silhouette.opacity + (-0.2 * (4.0 + 2.0 + 3.0_f64)).exp_m1()).abs() < TIGHT, "{silhouette:?}");
    assert!(silhouette.rgb.x < 0.5 * silhouette.opacity);
}

#[test]
fn a_probe_weighs_edges_by_importance_whatever_gamma_is() {
    let sloped = AnalyticField::new(DVec3::splat(10.0), |_| 0.5, |_| DVec3::new(0.0, 0.15, 0.0));
    let chain = [Enhancer::Probe(probe(DVec3::splat(0.05), 0.03))];
    let see = |importance: f64, gamma: f64| {
        let model = with_importance(fog(0.2), Curve::constant(importance), gamma, MimdaForm::Consistent);
        seen(with(model, &chain), TIGHT, &sloped, &x_ray())
    };
    let plain = seen(with(fog(0.2), &chain), TIGHT, &sloped, &x_ray());
    assert_eq!(see(1.0, 0.0), plain);
    // A gradient of three quarters counts as a sixth of that, and with it the edge: η is a smoothstep of both.
    assert!(difference(&see(1.0 / 6.0, 0.0), &plain) > 0.05);
    assert_close(see(1.0 / 6.0, 0.0), see(1.0 / 6.0, 1e-12), 1e-9);
    // A picker before the probe says what is important.
    let picked = |gamma: f64| {
        let model = with_importance(fog(0.2), Curve::constant(0.0), gamma, MimdaForm::Consistent);
        seen(with(model, &[picker([0.4, 0.5, 0.5, 0.6], 1.0), chain[0]]), TIGHT, &sloped, &x_ray())
    };
    assert_close(picked(0.0), plain, TIGHT);
}

#[test]
fn a_picker_replaces_importance_and_hides_the_rest() {
    // A full picker of the upper half: only s > 0.5 is seen, and where it starts importance is 1: with γ = 1 nothing
    // before it stays.
    let model = with_importance(fog(0.3), Curve::constant(0.4), 1.0, MimdaForm::Consistent);
    let field = along_x(|x| x / 10.0);
    let picked = with(model.clone(), &[picker([0.5, 0.5, 1.0, 1.0], 1.0)]);
    let opacity = seen(picked, TIGHT, &field, &x_ray()).opacity;
    assert!((opacity + (-0.3 * 5.0_f64).exp_m1()).abs() < TIGHT);
    // Half of it: importance 0.2 below and 0.7 above, extinction halved below.
    let half = with(model, &[picker([0.5, 0.5, 1.0, 1.0], 0.5)]);
    let opacity = seen(half, TIGHT, &field, &x_ray()).opacity;
    let (below, above) = (-(-0.75_f64).exp_m1(), -(-1.5_f64).exp_m1());
    let kept = below * 0.3 / 0.8;
    assert!((opacity - (kept + (1.0 - kept) * above)).abs() < TIGHT, "{opacity}");
}

#[test]
fn the_error_stays_below_the_tolerance() {
    let field = noisy_store(40);
    for chain in chains() {
        for gamma in [0.0, 0.7] {
            let frame = frame(with(busy_with_importance(gamma), &chain), Some(Light::default()));
            let at = |tolerance: f64| {
                let integrator = Integrator { tolerance, ..Integrator::default() };
                Tracer::new(&frame, integrator).unwrap().radiance_on(&field, &oblique()).unwrap()
            };
            let truth = at(1e-10);
            assert!(truth.opacity > 0.3);
            for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
                let seen = at(tolerance);
                let error = difference(&seen, &truth);
                assert!(seen.reached && error <= tolerance, "{tolerance:e}: {error:e} {seen:?}");
                println!(
                    "γ {gamma}, tolerance {tolerance:e}: error {error:e}, estimate {:e}",
                    seen.error_estimate
                );
            }
        }
    }
}

#[test]
fn opaque_and_empty_media_stay_numbers() {
    for chain in chains() {
        for per_voxel in [0.0, 1e-6, 1.0, 1e6] {
            let extinction =
                Curve::new(vec![(0.3, 0.0), (0.31, per_voxel), (0.6, per_voxel), (0.6, 0.0)]).unwrap();
            let model = Optics { extinction, ..busy_with_importance(1.0) };
            let frame = frame(with(model, &chain), Some(Light::default()));
            let tracer = Tracer::new(&frame, Integrator::default()).unwrap();
            let seen = tracer.radiance_on(&noisy_store(40), &oblique()).unwrap();
            assert!(seen.reached && seen.rgb.is_finite(), "{per_voxel}: {seen:?}");
            assert!((0.0..=1.0).contains(&seen.opacity), "{per_voxel}: {seen:?}");
        }
    }
}

#[test]
fn one_segment_each_way_is_the_whole_without_importance() {
    let field = noisy_store(40);
    let tracer = tracer(with(busy(), &chains()[1]), TIGHT);
    let whole = tracer.radiance_on(&field, &oblique()).unwrap();
    let segments = super::Segmentation::uniform(0.0, 1.0, 37).unwrap();
    assert_close(tracer.segmented_on(&field, &oblique(), &segments).unwrap(), whole, 40.0 * TIGHT);
}
