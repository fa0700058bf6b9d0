//! A ray's way through one brick: samples, light and steps.

use super::composite::{Accumulated, Composite, Light};
use super::sample::sample_brick;
use super::scene::BRICK_VOXELS;
use super::shade::{Lighting, Shade};
use super::tables::{attenuation_mean, locate, optics_between};
use super::traverse::{node_low, voxel_edge};
use super::{Real, Scene, ray::Ray, vector::Vec3};
use crate::layout::{CELL_WORDS, NodeRecord};

/// Texels of overlap on each side of a brick.
const OVERLAP: f64 = 2.0;
/// Texels along the edge of a cell.
const CELL: f64 = 4.0;

/// What stays the same on a ray's way through one brick.
pub(super) struct Brick<'a, F> {
    codes: &'a [u16; BRICK_VOXELS],
    cells: &'a [u32; CELL_WORDS],
    /// A point t metres along the ray lies at base + slope t, in texels of the brick.
    base: Vec3<F>,
    slope: Vec3<F>,
    /// Metres per texel along each axis, without sign.
    pace: Vec3<F>,
    gradient_scale: F,
    offset: F,
    scale: F,
}

/// One step along a ray.
pub(super) struct Step<F> {
    /// Mean of (τ c, τ).
    pub(super) k: [F; 4],
    /// At its ends.
    pub(super) scalars: (F, F),
    /// Where it begins.
    pub(super) t0: F,
    /// Metres.
    pub(super) length: F,
}

impl<'a, F: Real> Brick<'a, F> {
    #[inline(always)]
    pub(super) fn new(scene: &Scene<'a, F>, node: &NodeRecord, ray: &Ray<F>) -> Self {
        let finest = scene.view.finest_depth;
        let edge = voxel_edge::<F>(finest, node.depth);
        let overlap = F::of(OVERLAP);
        let scale = F::of_f32(node.scale);
        Self {
            codes: scene.brick(node.slot),
            cells: scene.cells(node.slot),
            base: (ray.origin_in_volume - node_low(finest, node)).map(|c| c / edge + overlap),
            slope: ray.direction_in_volume.map(|c| c / edge),
            pace: ray.inverse.map(|c| c.abs() * edge),
            gradient_scale: F::of(0.5) * scale / edge,
            offset: F::of_f32(node.offset),
            scale,
        }
    }

    /// The point at t, in texels.
    #[inline(always)]
    pub(super) fn point(&self, t: F) -> Vec3<F> {
        self.base + self.slope * t
    }

    #[inline(always)]
    pub(super) fn scalar_at(&self, t: F) -> F {
        let stored = sample_brick(self.codes, self.point(t));
        (self.offset + self.scale * stored).most(F::ZERO).least(F::ONE)
    }

    /// Whether anything shows within a voxel of the cell around a point.
    #[inline(always)]
    pub(super) fn is_visible_at(&self, point: Vec3<F>) -> bool {
        let [x, y, z] = point.0.map(|c| (c * F::of(1.0 / CELL)).to_index() & 7);
        let cell = (z * 8 + y) * 8 + x;
        self.cells[(cell >> 5) as usize] >> (cell & 31) & 1 != 0
    }

    /// Pairs of steps of `length` metres until the middle of one lies beyond the cell around `middle`; at least 1.
    #[inline(always)]
    pub(super) fn pairs_across(&self, middle: Vec3<F>, length: F) -> u32 {
        let mut way = F::of(1e30);
        for axis in 0..3 {
            let in_cells = middle.0[axis] * F::of(1.0 / CELL);
            let low = F::of_u32(in_cells.to_index()) * F::of(CELL);
            let face = if self.slope.0[axis] >= F::ZERO { low + F::of(CELL) } else { low };
            way = way.least((face - middle.0[axis]).abs() * self.pace.0[axis]);
        }
        (way / length).ceil().most(F::ONE).least(F::of(1e6)).to_index()
    }

    /// The light at t, where there is extinction to be lit.
    #[inline(always)]
    pub(super) fn lighting<S: Shade>(
        &self,
        scene: &Scene<F>,
        ray: &Ray<F>,
        extinction: F,
        t: F,
    ) -> Lighting<F> {
        if extinction > F::ZERO {
            S::lighting(scene.view, self.codes, self.point(t), self.gradient_scale, ray)
        } else {
            Lighting::NONE
        }
    }

    /// Adds one step, lit as given.
    #[inline(always)]
    pub(super) fn add_whole<C: Composite>(
        &self,
        scene: &Scene<F>,
        front: Accumulated<F>,
        step: &Step<F>,
        light: Lighting<F>,
    ) -> Accumulated<F> {
        if C::is_clear(step.k[3]) {
            return front;
        }
        let thickness = scene.view.extinction_per_metre * step.length;
        C::composite(scene, front, segment_light(step.k, thickness, light), step.scalars)
    }

    /// Adds one step, cut into parts.
    #[inline(always)]
    pub(super) fn add_parts<S: Shade, C: Composite>(
        &self,
        scene: &Scene<F>,
        ray: &Ray<F>,
        mut front: Accumulated<F>,
        step: &Step<F>,
        parts: F,
    ) -> Accumulated<F> {
        let part = step.length / parts;
        let thickness = scene.view.extinction_per_metre * part;
        let mut alone = Light::NONE;
        let (mut from, end) = step.scalars;
        let mut from_located = locate(scene.optics, from);
        let count = parts.to_index();
        for j in 1..=count {
            let t = step.t0 + F::of_u32(j) * part;
            let to = if j < count { self.scalar_at(t) } else { end };
            let to_located = locate(scene.optics, to);
            let k = optics_between(scene.optics, &from_located, &to_located);
            if !C::is_clear(k[3]) {
                let light = self.lighting::<S>(scene, ray, k[3], t - F::of(0.5) * part);
                let light = segment_light(k, thickness, light);
                if C::ONCE_PER_STEP {
                    alone = alone.then(light);
                } else {
                    front = C::composite(scene, front, light, (from, to));
                }
            }
            (from, from_located) = (to, to_located);
        }
        if C::ONCE_PER_STEP { C::composite(scene, front, alone, step.scalars) } else { front }
    }
}

/// Light of a segment with mean `k` of (τ c, τ), composited alone; `thickness` is metres times the extinction per metre
/// where the table says 1.
#[inline(always)]
fn segment_light<F: Real>(k: [F; 4], thickness: F, light: Lighting<F>) -> Light<F> {
    let depth = k[3] * thickness;
    let mean = attenuation_mean(depth);
    Light { rgb: light.on(k) * (thickness * mean), alpha: depth * mean }
}
