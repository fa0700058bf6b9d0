//! One ray from a pixel to its colour.

use super::composite::{Accumulated, Composite, MimdaConsistent, MimdaPaper, Over};
use super::shade::{Phong, Plain, Shade};
use super::tables::{attenuation_mean, optics_between};
use super::traverse::{node_low, voxel_edge};
use super::{Real, Scene, ray::Ray, sample::sample_brick, vector::Vec3};
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

#[inline(always)]
fn scalar_of<F: Real>(stored: F, node: &NodeRecord) -> F {
    (F::of_f32(node.offset) + F::of_f32(node.scale) * stored).most(F::ZERO).least(F::ONE)
}

/// Follows the ray through one brick, from t_in to t_out, in equal steps.
#[inline(always)]
fn march<F: Real, S: Shade, C: Composite>(
    scene: &Scene<F>,
    front: Accumulated<F>,
    node: &NodeRecord,
    ray: &Ray<F>,
    (t_in, t_out): (F, F),
) -> Marched<F> {
    let view = scene.view;
    let brick = scene.brick(node.slot);
    let edge = voxel_edge::<F>(view.finest_depth, node.depth);
    let span = t_out - t_in;
    let steps = (span * ray.speed / (view.step_voxels * edge)).ceil().most(F::ONE);
    let step = span / steps;
    let overlap = F::of(OVERLAP);
    let base = (ray.origin_in_volume - node_low(view.finest_depth, node)).map(|c| c / edge + overlap);
    let slope = ray.direction_in_volume.map(|c| c / edge);
    let gradient_scale = F::of(0.5) * F::of_f32(node.scale) / edge;
    let thickness = view.extinction_per_metre * step;
    let mut marched = Marched { front, samples: 1, is_done: false };
    let mut s0 = scalar_of(sample_brick(brick, base + slope * t_in), node);
    for i in 1..=steps.to_index() {
        let t = t_in + F::of_u32(i) * step;
        let s1 = scalar_of(sample_brick(brick, base + slope * t), node);
        marched.samples += 1;
        let k = optics_between(scene.optics, s0, s1);
        if !C::is_clear(k[3]) {
            let depth = k[3] * thickness;
            let mean = attenuation_mean(depth);
            let lit = if k[3] > F::ZERO {
                let middle = base + slope * (t - F::of(0.5) * step);
                S::shade(view, brick, k, middle, gradient_scale, ray)
            } else {
                Vec3::ZERO
            };
            marched.front =
                C::composite(scene, marched.front, lit * (thickness * mean), depth * mean, s0, s1);
            if C::still_to_come(scene, marched.front) < view.termination {
                marched.is_done = true;
                break;
            }
        }
        s0 = s1;
    }
    marched
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
