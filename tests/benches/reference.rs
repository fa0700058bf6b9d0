//! What a ray of the reference costs in a large volume, under enhancers and where light bends.
//!
//! `cargo bench -p lightloom-tests --bench reference`

use bricks::LodRule;
use glam::{DAffine3, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use optics::{
    BandPicker, ClipPlane, Curve, Enhancer, Light, Mimda, MimdaForm, Optics, Probe, Ramp, Trapezoid,
};
use protocol::FrameState;
use reference::{Integrator, Radiance, Ray, StoredField, Tracer};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Voxels along an edge.
const EDGE: u32 = 256;
const VOXEL_M: f64 = 0.01;
/// Rays of which the mean time is taken.
const RAYS: u32 = 20;

/// Waves some tens of voxels long.
fn waves(p: DVec3) -> f64 {
    let wave = |k: DVec3, phase: f64| (0.1 * k.dot(p) + phase).sin();
    let sum = wave(DVec3::new(0.9, 0.4, -0.6), 0.3)
        + wave(DVec3::new(-0.5, 1.1, 0.7), 1.9)
        + wave(DVec3::new(0.31, -0.45, 0.83), 4.1);
    0.5 + sum / 6.0
}

fn place() -> DAffine3 {
    DAffine3::from_scale(DVec3::splat(VOXEL_M))
}

/// The waves, at the finest level everywhere.
fn field() -> StoredField {
    let rule = LodRule {
        display_from_volume: place(),
        pixel_size_m: 0.0015,
        angular_accuracy: 0.014,
        lod_scale: 0.0,
    };
    StoredField::new(Arc::new(ClosureVolume::new(UVec3::splat(EDGE), (0.0, 1.0), waves)), &rule)
}

fn thin() -> Optics {
    let extinction = vec![(0.2, 0.0), (0.3, 0.01), (0.6, 0.005), (0.8, 0.02)];
    let colours = vec![(0.0, DVec3::X), (0.4, DVec3::Y), (0.7, DVec3::Z), (1.0, DVec3::ONE)];
    let curve = "the points rise";
    Optics::plain((0.0, 1.0), Curve::new(extinction).expect(curve), Curve::new(colours).expect(curve))
}

/// Three enhancers that reach far into the volume.
fn chain() -> [Enhancer; 3] {
    let facing = Ramp { low: -2.0, high: -1.0 };
    let plane = ClipPlane {
        point_in_display: DVec3::new(0.5, 0.0, 0.0),
        normal_in_display: DVec3::NEG_X,
        context: Ramp { low: 2.0, high: 3.0 },
        thickness_m: 1.0,
        boost: 2.0,
        strength: 1.0,
    };
    let probe = Probe {
        centre_in_display: DVec3::splat(1.28),
        radius_m: 0.8,
        axis_in_display: DVec3::X,
        facing,
        gradient_most: 0.2,
        edges: Ramp { low: 0.0, high: 1.0 },
        strength: 1.0,
    };
    let band = Trapezoid::new([0.2, 0.4, 0.4, 0.6]).expect("the corners rise");
    let picker = BandPicker { band, axis_in_display: DVec3::X, facing, strength: 0.8 };
    [Enhancer::ClipPlane(plane), Enhancer::Probe(probe), Enhancer::BandPicker(picker)]
}

/// The mean time of a ray through the volume, after one that loads the bricks, and what it sees.
fn time(field: &StoredField, optics: Optics, integrator: Integrator) -> (Duration, Radiance) {
    let frame = FrameState::still(DVec3::new(0.0, 0.0, 3.0), place(), optics);
    let frame = FrameState { light: Some(Light::default()), ..frame };
    let tracer = Tracer::new(&frame, integrator).expect("the model is whole");
    let ray = Ray::new(DVec3::new(-0.2, 0.3, 0.41), DVec3::new(1.0, 0.31, 0.27));
    let see = || tracer.radiance_on(field, &ray).expect("a formula can be read");
    let seen = see();
    let since = Instant::now();
    (0..RAYS).for_each(|_| assert_eq!(see(), seen, "a ray does not repeat itself"));
    (since.elapsed() / RAYS, seen)
}

fn main() {
    let field = field();
    for (gamma, count) in [(0.0, 0), (0.0, 1), (0.0, 3), (0.7, 0), (0.7, 3)] {
        let importance = Curve::new(vec![(0.0, 0.0), (1.0, 1.0)]).expect("the points rise");
        let mimda = Some(Mimda { importance, gamma, form: MimdaForm::Consistent });
        let optics = Optics { mimda, enhancers: chain()[..count].to_vec(), ..thin() };
        let (each, seen) = time(&field, optics, Integrator::default());
        println!("γ {gamma}, {count} enhancers: {each:?} a ray, {seen:?}");
    }
    for index in [&[(0.0, 1.0), (1.0, 1.02)][..], &[(0.0, 1.0), (1.0, 1.2)], &[(0.6, 1.0), (0.6, 1.3)]] {
        for tolerance in [1e-3, 1e-4, 1e-5] {
            let refraction = Some(Curve::new(index.to_vec()).expect("the points rise"));
            let integrator = Integrator { tolerance, ..Integrator::default() };
            let (each, seen) = time(&field, Optics { refraction, ..thin() }, integrator);
            println!("index {index:?}, tolerance {tolerance:e}: {each:?} a ray, {seen:?}");
        }
    }
}
