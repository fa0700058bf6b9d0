//! One ray from a pixel to its colour.

use super::composite::{Accumulated, Composite, Light, MimdaConsistent, MimdaPaper, Over};
use super::shade::{Phong, Plain, Shade};
use super::tables::{attenuation_mean, optics_between};
use super::traverse::{node_low, voxel_edge};
use super::{
    Real, Scene,
    ray::Ray,
    refine::{Pair, parts_of_step, scalars_in_reach},
    sample::sample_brick,
    scene::BRICK_VOXELS,
    vector::Vec3,
};
use crate::compose::{Compositing, Shading};
use crate::layout::{NO_NODE, NO_SLOT, NodeRecord};
use crate::optics::MimdaForm;

/// Texels of overlap on each side of a brick.
const OVERLAP: f64 = 2.0;

/// What one ray brings back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast<F> {
    /// Premultiplied linear RGB and opacity.
    pub rgba: [F; 4],
    /// Samples of the volume, gradients not counted.
    pub samples: u32,
    /// Whether a node on the way was too coarse.
    pub is_missing: bool,
}

/// Casts the ray of pixel (x, y) with the modules that a kernel of these slots has.
#[inline(always)]
pub fn cast_pixel<F: Real>(
    scene: &Scene<F>,
    shading: Shading,
    compositing: Compositing,
    x: u32,
    y: u32,
) -> Cast<F> {
    let half = F::of(0.5);
    let ray = Ray::of_pixel(scene.view, F::of_u32(x) + half, F::of_u32(y) + half);
    match (shading, compositing) {
        (Shading::Plain, Compositing::Over) => cast_ray::<F, Plain, Over>(scene, &ray),
        (Shading::Phong, Compositing::Over) => cast_ray::<F, Phong, Over>(scene, &ray),
        (Shading::Plain, Compositing::Mimda(MimdaForm::Paper)) => {
            cast_ray::<F, Plain, MimdaPaper>(scene, &ray)
        }
        (Shading::Phong, Compositing::Mimda(MimdaForm::Paper)) => {
            cast_ray::<F, Phong, MimdaPaper>(scene, &ray)
        }
        (Shading::Plain, Compositing::Mimda(MimdaForm::Consistent)) => {
            cast_ray::<F, Plain, MimdaConsistent>(scene, &ray)
        }
        (Shading::Phong, Compositing::Mimda(MimdaForm::Consistent)) => {
            cast_ray::<F, Phong, MimdaConsistent>(scene, &ray)
        }
    }
}

struct Marched<F> {
    front: Accumulated<F>,
    samples: u32,
    is_done: bool,
}

/// What stays the same on a ray's way through one brick.
struct Brick<'a, F> {
    codes: &'a [u16; BRICK_VOXELS],
    /// A point t metres along the ray lies at base + slope t, in texels of the brick.
    base: Vec3<F>,
    slope: Vec3<F>,
    gradient_scale: F,
    offset: F,
    scale: F,
}

impl<'a, F: Real> Brick<'a, F> {
    #[inline(always)]
    fn new(scene: &Scene<'a, F>, node: &NodeRecord, ray: &Ray<F>) -> Self {
        let finest = scene.view.finest_depth;
        let edge = voxel_edge::<F>(finest, node.depth);
        let overlap = F::of(OVERLAP);
        let scale = F::of_f32(node.scale);
        Self {
            codes: scene.brick(node.slot),
            base: (ray.origin_in_volume - node_low(finest, node)).map(|c| c / edge + overlap),
            slope: ray.direction_in_volume.map(|c| c / edge),
            gradient_scale: F::of(0.5) * scale / edge,
            offset: F::of_f32(node.offset),
            scale,
        }
    }

    #[inline(always)]
    fn scalar_at(&self, t: F) -> F {
        let stored = sample_brick(self.codes, self.base + self.slope * t);
        (self.offset + self.scale * stored).most(F::ZERO).least(F::ONE)
    }

    /// Light of a segment of `thickness` with its middle at t, composited alone.
    #[inline(always)]
    fn segment_light<S: Shade>(
        &self,
        scene: &Scene<F>,
        ray: &Ray<F>,
        k: [F; 4],
        t: F,
        thickness: F,
    ) -> Light<F> {
        if k[3] <= F::ZERO {
            return Light::NONE;
        }
        let depth = k[3] * thickness;
        let mean = attenuation_mean(depth);
        let middle = self.base + self.slope * t;
        let lit = S::shade(scene.view, self.codes, k, middle, self.gradient_scale, ray);
        Light { rgb: lit * (thickness * mean), alpha: depth * mean }
    }

    /// Adds one step, cut into parts.
    #[inline(always)]
    fn add_step<S: Shade, C: Composite>(
        &self,
        scene: &Scene<F>,
        ray: &Ray<F>,
        mut front: Accumulated<F>,
        step: &Step<F>,
        parts: F,
    ) -> Accumulated<F> {
        let Step { k, scalars: (s0, s1), t0, length } = *step;
        let thickness = scene.view.extinction_per_metre * length;
        let half = F::of(0.5);
        if parts == F::ONE {
            if C::is_clear(k[3]) {
                return front;
            }
            let light = self.segment_light::<S>(scene, ray, k, t0 + half * length, thickness);
            return C::composite(scene, front, light, (s0, s1));
        }
        let mut alone = Light::NONE;
        let part = length / parts;
        let mut from = s0;
        let count = parts.to_index();
        for j in 1..=count {
            let t = t0 + F::of_u32(j) * part;
            let to = if j < count { self.scalar_at(t) } else { s1 };
            let mean = optics_between(scene.optics, from, to);
            if !C::is_clear(mean[3]) {
                let light = self.segment_light::<S>(scene, ray, mean, t - half * part, thickness / parts);
                if C::ONCE_PER_STEP {
                    alone = alone.then(light);
                } else {
                    front = C::composite(scene, front, light, (from, to));
                }
            }
            from = to;
        }
        if C::ONCE_PER_STEP { C::composite(scene, front, alone, (s0, s1)) } else { front }
    }
}

/// One step along a ray.
struct Step<F> {
    /// Mean of (τ c, τ).
    k: [F; 4],
    /// At its ends.
    scalars: (F, F),
    /// Where it begins.
    t0: F,
    /// Metres.
    length: F,
}

/// Follows the ray through one brick, from t_in to t_out, in equal pairs of steps. Where a pair tells that its steps
/// are too long for the tolerance, each of them is cut into equal parts.
#[inline(always)]
fn march<F: Real, S: Shade, C: Composite>(
    scene: &Scene<F>,
    mut front: Accumulated<F>,
    node: &NodeRecord,
    ray: &Ray<F>,
    (t_in, t_out): (F, F),
) -> Marched<F> {
    let view = scene.view;
    let brick = Brick::new(scene, node, ray);
    let (half, two) = (F::of(0.5), F::of(2.0));
    let span = t_out - t_in;
    let longest_pair = two * view.step_voxels * voxel_edge::<F>(view.finest_depth, node.depth);
    let pairs = (span * ray.speed / longest_pair).ceil().most(F::ONE);
    let step = half * span / pairs;
    let thickness = view.extinction_per_metre * step;
    let mut samples = 1;
    let mut s0 = brick.scalar_at(t_in);
    for i in 0..pairs.to_index() {
        let t0 = t_in + two * F::of_u32(i) * step;
        let s1 = brick.scalar_at(t0 + step);
        let s2 = brick.scalar_at(t0 + two * step);
        samples += 2;
        let first = optics_between(scene.optics, s0, s1);
        let second = optics_between(scene.optics, s1, s2);
        let (low, high) = scalars_in_reach(s0, s1, s2);
        let reach = optics_between(scene.optics, low, high);
        if !C::is_clear(reach[3]) {
            let pair = Pair { first, second, both: optics_between(scene.optics, s0, s2), reach };
            let visible = C::still_to_come(scene, front);
            let parts = parts_of_step(&pair, thickness, visible, F::of(S::SPREAD), view.tolerance)
                .most(C::parts_of_rise(scene, front, (low, high)));
            let step_of = |k, scalars, t0| Step { k, scalars, t0, length: step };
            front = brick.add_step::<S, C>(scene, ray, front, &step_of(first, (s0, s1), t0), parts);
            front = brick.add_step::<S, C>(scene, ray, front, &step_of(second, (s1, s2), t0 + step), parts);
            samples += 2 * (parts.to_index() - 1);
            if C::still_to_come(scene, front) < view.termination {
                return Marched { front, samples, is_done: true };
            }
        }
        s0 = s2;
    }
    Marched { front, samples, is_done: false }
}

#[inline(always)]
fn cast_ray<F: Real, S: Shade, C: Composite>(scene: &Scene<F>, ray: &Ray<F>) -> Cast<F> {
    let mut front = Accumulated::NOTHING;
    let mut cast = Cast { rgba: [F::ZERO; 4], samples: 0, is_missing: false };
    let (mut t, t_end) = ray.clip_to_volume(scene.view.dims);
    // Not `t >= t_end`: a span that is not a number is empty, too.
    if !matches!(t.partial_cmp(&t_end), Some(std::cmp::Ordering::Less)) {
        return cast;
    }
    let mut at = scene.leaf_at(ray.point(t), ray);
    while at != NO_NODE {
        let node = &scene.nodes[at as usize];
        let exit = scene.exit_of(node, ray);
        let t_out = exit.t.most(t).least(t_end);
        if node.slot != NO_SLOT && t_out > t {
            scene.feedback[at as usize].note(node.deficit);
            let marched = march::<F, S, C>(scene, front, node, ray, (t, t_out));
            front = marched.front;
            cast.samples += marched.samples;
            cast.is_missing |= node.deficit > 0.0;
            if marched.is_done {
                break;
            }
        }
        if t_out >= t_end {
            break;
        }
        t = t_out;
        at = scene.leaf_beyond(node, exit.axis, ray.point(t), ray);
    }
    let [r, g, b] = front.rgb.0;
    cast.rgba = [r, g, b, front.alpha];
    cast
}
