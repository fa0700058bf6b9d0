//! One ray from a pixel to its colour.

use super::brick::{Brick, Step};
use super::composite::{Accumulated, Composite, MimdaConsistent, MimdaPaper, Over};
use super::shade::{Phong, Plain, Shade};
use super::tables::{is_vacant, locate};
use super::traverse::voxel_edge;
use super::{
    Real, Scene,
    ray::Ray,
    refine::{Pair, parts_of_step, scalars_in_reach, step_voxels},
};
use crate::compose::{Compositing, Shading};
use crate::layout::{NO_NODE, NO_SLOT, NodeRecord};
use crate::optics::MimdaForm;

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
    let two = F::of(2.0);
    let span = t_out - t_in;
    let edge = voxel_edge::<F>(view.finest_depth, node.depth);
    let depth = F::of_f32(node.most_extinction) * view.extinction_per_metre * (edge / ray.speed);
    let longest = step_voxels(view.step_voxels, depth, F::of(S::SAFE_DEPTH), view.tolerance);
    let pairs = (span * ray.speed / (two * longest * edge)).ceil().most(F::ONE);
    let step = F::of(0.5) * span / pairs;
    let count = pairs.to_index();
    let mut marched = Marched { front, samples: 0, is_done: false };
    let mut i = 0;
    let mut known = None;
    while i < count {
        let t0 = t_in + two * F::of_u32(i) * step;
        let middle = brick.point(t0 + step);
        if !brick.is_visible_at(middle) {
            i += brick.pairs_across(middle, two * step);
            known = None;
            continue;
        }
        i += 1;
        let s0 = known.unwrap_or_else(|| {
            marched.samples += 1;
            brick.scalar_at(t0)
        });
        let s1 = brick.scalar_at(t0 + step);
        let s2 = brick.scalar_at(t0 + two * step);
        marched.samples += 2;
        known = Some(s2);
        let (low, high) = scalars_in_reach(s0, s1, s2);
        if is_vacant(scene.occupied, low, high) {
            continue;
        }
        let [l0, l1, l2] = [s0, s1, s2].map(|s| locate(scene.optics, s));
        let pair = Pair::new(scene.optics, [&l0, &l1, &l2], (low, high));
        let visible = C::still_to_come(scene, front);
        let thickness = view.extinction_per_metre * step;
        let parts = parts_of_step(&pair, thickness, visible, F::of(S::SPREAD), view.tolerance)
            .most(C::parts_of_rise(scene, front, (low, high)));
        let steps = [
            Step { k: pair.first, scalars: (s0, s1), t0, length: step },
            Step { k: pair.second, scalars: (s1, s2), t0: t0 + step, length: step },
        ];
        if parts == F::ONE {
            // The light in the middle of the pair serves both steps.
            let light = brick.lighting::<S>(scene, ray, pair.first[3].most(pair.second[3]), t0 + step);
            front = brick.add_whole::<C>(scene, front, &steps[0], light);
            front = brick.add_whole::<C>(scene, front, &steps[1], light);
        } else {
            front = brick.add_parts::<S, C>(scene, ray, front, &steps[0], parts);
            front = brick.add_parts::<S, C>(scene, ray, front, &steps[1], parts);
            marched.samples += 2 * (parts.to_index() - 1);
        }
        if C::still_to_come(scene, front) < view.termination {
            marched.is_done = true;
            break;
        }
    }
    marched.front = front;
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
