//! The laws that filtering over levels, detail and materials must keep.

use super::test_scene::*;
use super::{Field, Integrator, Radiance, Ray, Reference, StoredField, Tracer};
use bricks::LodRule;
use bricks::NodeKey;
use glam::{DVec3, UVec3};
use optics::{Curve, Detail, Light, Material, Optics, Quality};
use protocol::FrameState;
use std::sync::Arc;

/// Rounding, in numbers of order one over a few hundred pieces.
const ROUNDING: f64 = 1e-11;
/// 16 bits over a brick, times what a picture may make of it.
const QUANTISATION: f64 = 1e-3;

/// A rule by which samples of the whole volume are filtered `level` levels above the finest.
fn flat(level: f64) -> LodRule {
    LodRule { pixel_size_m: VOXEL_M * level.exp2(), angular_accuracy: 0.0, lod_scale: 1.0, ..finest() }
}

/// The same, but with a resolution that doubles from the screen to 0.2 m behind it, and again to 0.6 m.
fn deep() -> LodRule {
    LodRule { pixel_size_m: VOXEL_M, angular_accuracy: 2.0 * 0.025_f64.atan(), lod_scale: 1.0, ..finest() }
}

fn source(edge: u32) -> Arc<FormulaSource> {
    FormulaSource::shared(UVec3::splat(edge), (0.0, 1.0), |p| noise(0.2 * p))
}

fn busy() -> Optics {
    let extinction = vec![(0.2, 0.0), (0.3, 0.05), (0.5, 0.02), (0.6, 0.02), (0.6, 0.09), (0.8, 0.0)];
    let colours = vec![(0.0, DVec3::X), (0.4, DVec3::Y), (0.7, DVec3::Z), (1.0, DVec3::ONE)];
    optics(Curve::new(extinction).unwrap(), Curve::new(colours).unwrap())
}

fn oblique() -> Ray {
    Ray::new(DVec3::new(-0.2, 0.03, 0.11), DVec3::new(1.0, 0.31, 0.57))
}

fn see(light: Light, tolerance: f64, field: &dyn Field, ray: &Ray) -> Radiance {
    let integrator = Integrator { tolerance, ..Integrator::default() };
    let seen = Tracer::new(&frame(busy(), Some(light)), integrator).unwrap().radiance_on(field, ray).unwrap();
    assert!(seen.reached && seen.rgb.is_finite(), "{seen:?}");
    seen
}

fn difference(a: &Radiance, b: &Radiance) -> f64 {
    (a.rgb - b.rgb).abs().max_element().max((a.opacity - b.opacity).abs())
}

fn detailed(detail: Detail) -> Light {
    Light { detail, ..Light::default() }
}

const UNSHARP: Detail = Detail::Unsharp { strength: 2.0 };
const EXAGGERATED: Detail = Detail::Exaggerated { contrast: 4.0 };

#[test]
fn a_level_of_zero_is_the_single_level() {
    let single = StoredField::new(source(80), &finest());
    for rule in [finest(), flat(0.0), flat(-3.0)] {
        let filtered = StoredField::new(source(80), &finest()).filtered(&rule);
        let (a, b) = (
            see(Light::default(), 1e-7, &single, &oblique()),
            see(Light::default(), 1e-7, &filtered, &oblique()),
        );
        assert!(difference(&a, &b) < ROUNDING, "{a:?} {b:?}");
    }
}

#[test]
fn a_whole_level_is_that_level_and_the_coarsest_goes_on_for_ever() {
    // 80 voxels: 4 bricks at the finest level, so that level 2 is the root.
    for (level, coarse) in [(1.0, 1.0), (2.0, 2.0), (5.0, 2.0)] {
        let single = StoredField::new(source(80), &flat(coarse));
        let filtered = StoredField::new(source(80), &finest()).filtered(&flat(level));
        let (a, b) = (
            see(Light::default(), 1e-7, &single, &oblique()),
            see(Light::default(), 1e-7, &filtered, &oblique()),
        );
        // Pieces are cut at leaf borders that the coarse field does not have.
        assert!(difference(&a, &b) < 2e-7, "{level}: {a:?} {b:?}");
        let p = DVec3::new(33.3, 41.7, 29.1);
        assert!((single.value(p).unwrap() - filtered.value(p).unwrap()).abs() < ROUNDING);
    }
    let root = StoredField::quadrilinear(source(20), &flat(3.0));
    let single = StoredField::new(source(20), &finest());
    let p = DVec3::new(3.3, 11.7, 9.1);
    assert_eq!(root.value(p).unwrap(), single.value(p).unwrap());
}

#[test]
fn between_two_levels_values_and_gradients_are_linear() {
    let at = |level: f64| StoredField::new(source(80), &finest()).filtered(&flat(level));
    let p = DVec3::new(33.3, 41.7, 29.1);
    let [low, between, high] =
        [1.0, 1.25, 2.0].map(|level| (at(level).value(p).unwrap(), at(level).gradient(p).unwrap()));
    assert!((between.0 - (0.75 * low.0 + 0.25 * high.0)).abs() < ROUNDING);
    assert!((between.1 - (0.75 * low.1 + 0.25 * high.1)).length() < ROUNDING);
    assert!((low.0 - high.0).abs() > 1e-3);
}

#[test]
fn a_linear_field_is_that_field_at_every_level() {
    let linear = || {
        FormulaSource::shared(UVec3::splat(80), (0.0, 1.0), |p| 0.1 + DVec3::new(0.006, 0.001, 0.003).dot(p))
    };
    let ray = Ray::new(DVec3::new(-0.2, 0.3, 0.25), DVec3::new(1.0, 0.1, 0.2));
    let within = (0.31, 0.9);
    let seen = |field: &StoredField, detail: Detail| {
        let tracer = Tracer::new(&frame(busy(), Some(detailed(detail))), Integrator::default()).unwrap();
        tracer.radiance_within(field, &ray, within).unwrap()
    };
    let single = seen(&StoredField::new(linear(), &finest()), Detail::None);
    for rule in [deep(), flat(0.4), flat(1.7)] {
        let filtered = StoredField::new(linear(), &finest()).filtered(&rule);
        assert!(difference(&seen(&filtered, Detail::None), &single) < QUANTISATION);
        // All levels have one gradient, so there is nothing to unsharpen.
        assert!(difference(&seen(&filtered, UNSHARP), &single) < QUANTISATION);
    }
    assert!(single.opacity > 0.3);
}

#[test]
fn values_do_not_jump_between_leaves_of_different_depth() {
    let rule = LodRule { pixel_size_m: 0.4 * VOXEL_M, ..deep() };
    let (smooth, jumpy) =
        (StoredField::quadrilinear(source(224), &rule), StoredField::new(source(224), &rule));
    let jump = |field: &StoredField, z: f64| {
        let at = |z: f64| field.value(DVec3::new(101.3, 57.9, z)).unwrap();
        (at(z - 1e-7) - at(z + 1e-7)).abs()
    };
    let borders = (1..8).map(|n| f64::from(28 * n));
    let most = |field: &StoredField| borders.clone().map(|z| jump(field, z)).fold(0.0, f64::max);
    assert!(most(&smooth) < 1e-4, "{:e}", most(&smooth));
    assert!(most(&jumpy) > 1e-3, "{:e}", most(&jumpy));
}

#[test]
fn a_walk_shows_the_values_of_the_points() {
    struct Check<'a>(&'a StoredField, super::Line, usize);
    impl super::Visitor for Check<'_> {
        fn wants(&self, _low: f64, _high: f64) -> bool {
            true
        }
        fn levels(&self) -> super::Levels {
            super::Levels::One
        }
        fn piece(&mut self, piece: &super::Piece) -> std::ops::ControlFlow<()> {
            for u in [0.1, 0.5, 0.8] {
                let point = self.1.at(piece.t0 + u * (piece.t1 - piece.t0));
                assert!((self.0.value(point).unwrap() - piece.value.at(u)).abs() < 1e-9);
                let gradient = DVec3::from_array((piece.gradient)(0).map(|g| g.at(u)));
                assert!((self.0.gradient(point).unwrap() - gradient).length() < 1e-7);
            }
            self.2 += 1;
            std::ops::ControlFlow::Continue(())
        }
    }
    let rule = LodRule { pixel_size_m: 0.8 * VOXEL_M, ..deep() };
    let line = Ray::new(DVec3::new(-0.1, 0.2, 0.05), DVec3::new(0.8, 0.3, 0.9))
        .line(&frame(busy(), None).display_from_volume.inverse());
    for field in [StoredField::quadrilinear(source(120), &rule), blended(), blended().filtered(&rule)] {
        let within = line.clip(field.extent(), (0.0, f64::INFINITY)).unwrap();
        let mut check = Check(&field, line, 0);
        field.walk(&line, within, 1e-10, &mut check).unwrap();
        assert!(check.2 > 100, "{}", check.2);
    }
}

/// Weights of every kind at the corners of the eight leaves of 112 voxels' depth 1, one of which is split.
fn blended() -> StoredField {
    let split = NodeKey::ROOT.child(3);
    let leaves = (0..8).map(|octant| NodeKey::ROOT.child(octant)).filter(|&leaf| leaf != split);
    let leaves = leaves.chain((0..8).map(|octant| split.child(octant)));
    let weights =
        |leaf: NodeKey| std::array::from_fn(|i| f64::from((leaf.cell.x as usize + 3 * i) as u32 % 5) / 4.0);
    StoredField::presented(source(112), leaves.map(|leaf| (leaf, weights(leaf))), &busy())
}

#[test]
fn a_corner_has_its_weight_and_the_parent_has_the_rest() {
    let key = NodeKey { depth: 2, cell: UVec3::new(1, 2, 0) };
    let all = |depth: u8| {
        (0..1 << depth).flat_map(move |x| {
            (0..1 << depth)
                .flat_map(move |y| (0..1 << depth).map(move |z| NodeKey { depth, cell: UVec3::new(x, y, z) }))
        })
    };
    let weights: [f64; 8] = std::array::from_fn(|i| 0.1 * i as f64 + 0.15);
    let of = |depth: u8, weights: [f64; 8]| {
        StoredField::presented(source(112), all(depth).map(|leaf| (leaf, weights)), &busy())
    };
    let [blended, own, parent] = [of(2, weights), of(2, [1.0; 8]), of(1, [1.0; 8])];
    for (corner, weight) in weights.into_iter().enumerate() {
        let far =
            [corner & 1, corner >> 1 & 1, corner >> 2].map(|bit| if bit == 1 { 1.0 - 1e-9 } else { 1e-9 });
        let at = (key.cell.as_dvec3() + DVec3::from_array(far)) * 28.0;
        let [seen, own, parent] = [&blended, &own, &parent].map(|field| field.value(at).unwrap());
        assert!((seen - (parent + (own - parent) * weight)).abs() < 1e-8 && (own - parent).abs() > 1e-4);
    }
}

#[test]
fn the_error_stays_below_the_tolerance() {
    let field = StoredField::quadrilinear(source(120), &LodRule { pixel_size_m: 0.8 * VOXEL_M, ..deep() });
    for detail in [Detail::None, UNSHARP, EXAGGERATED] {
        let truth = see(detailed(detail), 1e-10, &field, &oblique());
        for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
            let seen = see(detailed(detail), tolerance, &field, &oblique());
            let error = difference(&seen, &truth);
            println!("{detail:?}, tolerance {tolerance:e}: {error:e}");
            assert!(error <= tolerance, "{tolerance:e}: {error:e}");
        }
    }
}

#[test]
fn detail_shows_on_stored_samples_and_none_is_none() {
    let field = StoredField::new(source(80), &finest());
    let none = see(Light::default(), 1e-7, &field, &oblique());
    let idle = see(detailed(Detail::Unsharp { strength: 0.0 }), 1e-7, &field, &oblique());
    assert!(difference(&none, &idle) < 2e-7);
    for detail in [UNSHARP, EXAGGERATED] {
        assert!(difference(&none, &see(detailed(detail), 1e-7, &field, &oblique())) > 1e-3);
    }
}

#[test]
fn a_leaf_that_shows_nothing_by_its_own_values_shows_nothing() {
    // A store whose summaries say 0 is never seen, whatever its samples and their parents' are.
    let hidden = FormulaSource::shared(UVec3::splat(60), (0.0, 0.0), |p| noise(0.2 * p));
    let field = StoredField::new(hidden, &finest()).filtered(&flat(1.5));
    let seen = see(Light::default(), 1e-5, &field, &oblique());
    assert_eq!(seen, Radiance::NOTHING);
}

#[test]
fn a_reference_filters_as_its_frame_says() {
    let quality = Quality { quadrilinear: true, ..Quality::default() };
    let frame = FrameState { quality, ..frame(busy(), None) };
    let reference = Reference::new(source(80), &frame, &flat(0.5), Integrator::default()).unwrap();
    let p = DVec3::new(33.3, 41.7, 29.1);
    let filtered = StoredField::quadrilinear(source(80), &flat(0.5)).value(p).unwrap();
    assert_eq!(reference.field().value(p).unwrap(), filtered);
}

#[test]
fn one_material_is_the_lights_own_and_others_follow_the_scalar() {
    let field = StoredField::new(source(40), &finest());
    let light = Light::default();
    let model = |materials: Curve<Material>| Optics { materials: Some(materials), ..busy() };
    let seen = |optics: Optics, light: Light| {
        let integrator = Integrator { tolerance: 1e-8, ..Integrator::default() };
        Tracer::new(&frame(optics, Some(light)), integrator).unwrap().radiance_on(&field, &oblique()).unwrap()
    };
    let own = seen(busy(), light);
    assert!(difference(&seen(model(Curve::constant(light.material())), light), &own) < 2e-8);
    // Of a scalar that is 0.5 throughout, only the material half way counts.
    let ends = [0.2, 0.8].map(|x| Material { ambient: x, diffuse: 2.0 * x, specular: 0.0, shininess: 1.0 });
    let curve = Curve::new(vec![(0.0, ends[0]), (1.0, ends[1])]).unwrap();
    let model =
        Optics { materials: Some(curve), ..optics(Curve::constant(0.2), Curve::constant(DVec3::ONE)) };
    let even = super::AnalyticField::new(DVec3::splat(10.0), |_| 0.5, |_| DVec3::new(0.3, 0.0, 0.0));
    let tracer = Tracer::new(&frame(model, Some(light)), Integrator::default()).unwrap();
    let seen = tracer.radiance_on(&even, &Ray::new(DVec3::new(-0.1, 0.05, 0.05), DVec3::X)).unwrap();
    let w = 0.09 / (0.09 + light.gradient_half * light.gradient_half);
    let shown = 1.0 - w + w * (0.5 + light.toward_light_in_display.x);
    assert!((seen.rgb.x - shown * seen.opacity).abs() < 1e-5, "{seen:?} {shown}");
}
