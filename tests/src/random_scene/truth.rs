//! What every pixel of a scene should show, and how well it is conditioned.

use crate::compare::{TruePixel, lod_rule, places};
use bricks::{BrickSource, LodRule};
use display_config::Display;
use glam::{DAffine3, DVec3};
use protocol::FrameState;
use rayon::prelude::*;
use reference::{Integrator, Radiance, Ray, Reference};
use std::sync::{Arc, OnceLock};

/// Opacity from which a pixel shows anything.
pub(super) const LIT: f64 = 0.01;
/// How far rounding takes a sample from its place, voxels: a texture unit is asked at 1/4096 of a texel, and f32 holds a place
/// a thousand voxels away to as much; several of these add up.
const PLACE_VOXELS: f64 = 1.0 / 2048.0;
/// The same as a share of the way from the eye: an origin and a direction of f32, a few operations after another.
const PLACE_SHARE: f64 = 1e-6;
/// How far rounding takes a scalar, share of the domain: eight samples mixed, scaled and looked up in f32, at 2^-24 each.
const SCALAR: f64 = 1.0 / 1_048_576.0;
/// Directions along which a place is moved, and the scalar's sign: a tetrahedron, so that no gradient is across all four.
const MOVES: [(DVec3, f64); 4] = [
    (DVec3::new(1.0, 1.0, 1.0), 1.0),
    (DVec3::new(1.0, -1.0, -1.0), -1.0),
    (DVec3::new(-1.0, 1.0, -1.0), 1.0),
    (DVec3::new(-1.0, -1.0, 1.0), -1.0),
];

/// The truth of some projectors' pixels. What moves it is found where somebody asks.
pub struct Truth {
    /// Every pixel asked for whose truth is known to a hundredth of what is tested.
    pub pixels: Vec<TruePixel>,
    unknown: usize,
    rays: Vec<Ray>,
    conditions: Vec<OnceLock<f64>>,
    display_from_volume: DAffine3,
    centre_in_display: DVec3,
    scene: Moved,
    moved: OnceLock<[Reference; 2]>,
}

/// A scene that scalars can be moved in.
struct Moved {
    source: Arc<dyn BrickSource>,
    frame: FrameState,
    rule: LodRule,
}

impl Moved {
    /// The reference, with every scalar moved by a share of the domain.
    fn reference(&self, by: f64) -> Reference {
        let mut frame = self.frame.clone();
        let (low, high) = frame.optics.domain;
        let shift = by * (high - low);
        frame.optics.domain = (low - shift, high - shift);
        Reference::new(Arc::clone(&self.source), &frame, &self.rule, Integrator::default())
            .expect("a test scene has a reference")
    }
}

fn seen(reference: &Reference, ray: &Ray) -> Radiance {
    reference
        .radiance(ray.origin_in_display, ray.direction_in_display)
        .expect("every brick of a test scene can be read")
}

impl Truth {
    /// Of a frame, every `stride`-th pixel of `projectors` along either axis.
    pub fn new(
        display: &Display,
        frame: &FrameState,
        source: &Arc<dyn BrickSource>,
        projectors: &[u32],
        stride: u32,
    ) -> Self {
        let scene =
            Moved { source: Arc::clone(source), frame: frame.clone(), rule: lod_rule(display, frame) };
        let reference = scene.reference(0.0);
        let places = places(display, projectors, stride);
        let all = places.len();
        let (pixels, rays): (Vec<TruePixel>, Vec<Ray>) = places
            .into_par_iter()
            .map(|(projector, x, y)| {
                let ray = ray_of(display, frame, (projector, x, y));
                (TruePixel { projector, x, y, truth: seen(&reference, &ray) }, ray)
            })
            .filter(|(pixel, _)| pixel.truth.reached)
            .unzip();
        let dims = source.shape().dims().as_dvec3();
        Self {
            unknown: all - pixels.len(),
            conditions: pixels.iter().map(|_| OnceLock::new()).collect(),
            pixels,
            rays,
            display_from_volume: frame.display_from_volume,
            centre_in_display: frame.display_from_volume.transform_point3(0.5 * dims),
            scene,
            moved: OnceLock::new(),
        }
    }

    /// Pixels whose truth is known, and those of which it is not.
    pub fn known(&self) -> [usize; 2] {
        [self.pixels.len(), self.unknown]
    }

    /// How far a pixel's worst number moves when its ray and its scalars move by what rounding moves them.
    pub fn condition(&self, index: usize) -> f64 {
        *self.conditions[index].get_or_init(|| {
            let moved = self.moved.get_or_init(|| [SCALAR, -SCALAR].map(|by| self.scene.reference(by)));
            let (ray, truth) = (&self.rays[index], numbers(&self.pixels[index].truth));
            let way_m = ray.origin_in_display.distance(self.centre_in_display);
            let far = |(direction, sign): (DVec3, f64)| {
                let by_voxels = self.display_from_volume.transform_vector3(direction * PLACE_VOXELS);
                let by = by_voxels + by_voxels.normalize() * (PLACE_SHARE * way_m);
                let ray = Ray { origin_in_display: ray.origin_in_display + by, ..*ray };
                let found = numbers(&seen(&moved[usize::from(sign < 0.0)], &ray));
                (0..4).map(|c| (found[c] - truth[c]).abs()).fold(0.0, f64::max)
            };
            MOVES.map(far).into_iter().fold(0.0, f64::max)
        })
    }
}

/// Colour and opacity.
pub(super) fn numbers(radiance: &Radiance) -> [f64; 4] {
    let [r, g, b] = radiance.rgb.to_array();
    [r, g, b, radiance.opacity]
}

fn ray_of(display: &Display, frame: &FrameState, (projector, x, y): (u32, u32, u32)) -> Ray {
    let law = display
        .beam_law(projector as usize, frame.observer_in_display, frame.eta)
        .expect("a test scene goes with its display");
    let ray = law.ray(display.pixel_on_screen(projector as usize, x, y));
    Ray::new(ray.origin_in_display, ray.direction_in_display)
}
