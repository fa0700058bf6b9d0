//! Cells too steep for means, met by eight neighbouring rays of a view.

use crate::fine::{FineTable, Looked, mean_between};
use crate::rough::Roughness;
use crate::slab::LANES;
use lanes::*;
use twin::Casting;
use twin::gradient::LEAST_SQUARE;
use twin::refine::parts_by_errors;

/// Parts of half a cell, at most, unless they are opaque.
const MOST_PARTS: f32 = 32.0;

/// What eight rays meet between two depths.
#[derive(Clone, Copy)]
pub(crate) struct Cell<S: Simd> {
    pub(crate) scalars: [f32x8<S>; 2],
    /// Optical depth where the table says 1; 0 for rays that meet nothing.
    pub(crate) thickness: f32x8<S>,
    /// Along each axis at both ends, where light falls.
    pub(crate) gradient: Option<[[f32x8<S>; 2]; 3]>,
}

/// What light makes of colours: τ c · body + τ · highlight.
#[derive(Clone, Copy)]
pub(crate) struct Light<S: Simd> {
    body: f32x8<S>,
    highlight: f32x8<S>,
}

/// Of a gradient: 1 over its length, and how much of a surface it makes.
#[derive(Clone, Copy)]
struct Direction<S: Simd> {
    per_length: f32x8<S>,
    weight: f32x8<S>,
}

/// Of eight pixels: premultiplied red, green and blue, then how much of the light from behind gets through.
pub(crate) type Pixels<S> = [f32x8<S>; 4];

/// What cells are looked at with.
#[derive(Clone, Copy)]
pub(crate) struct Steep<'a> {
    pub(crate) casting: &'a Casting<'a, f32>,
    pub(crate) fine: &'a FineTable,
    pub(crate) roughness: &'a Roughness,
    pub(crate) tolerance: f32,
}

impl Steep<'_> {
    /// Adds a cell whose scalars look up `front` and `back`; the light on it falls along `halfway` (toward the light, less the
    /// ray's direction; a unit vector).
    #[inline(never)]
    pub(crate) fn add<S: Simd>(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        cell: &Cell<S>,
        [front, back]: [&Looked<S>; 2],
        halfway: [f32x8<S>; 3],
    ) {
        outlined!(simd => {
        let [s0, s1] = cell.scalars;
        let half = splat(simd, 0.5);
        let whole = mean_between(simd, front, back, s1 - s0);
        if !whole[3].simd_gt(splat(simd, 0.0)).any_true() {
            return;
        }
        let ends = [front.value, whole, back.value];
        if self.is_one(simd, ends, cell.thickness, pixels[3]) {
            composite(simd, pixels, whole, cell.thickness, self.light_halfway(simd, cell.gradient, halfway));
            return;
        }
        let apart = half * (s1 - s0);
        let middle = self.fine.look_up(simd, s0 + apart);
        let a = mean_between(simd, front, &middle, apart);
        let b = mean_between(simd, &middle, back, apart);
        let lights = self.lights(simd, cell.gradient, halfway);
        let thickness = half * cell.thickness;
        let parts = self.parts(simd, (a, b), thickness, pixels[3]);
        if parts <= 1.0 {
            composite(simd, pixels, a, thickness, lights[0]);
            composite(simd, pixels, b, thickness, lights[1]);
            return;
        }
        let count = 2 * parts as u32;
        let share = 1.0 / count as f32;
        let part = (s1 - s0) * splat(simd, share);
        let thickness = cell.thickness * splat(simd, share);
        let mut from = *front;
        for j in 1..=count {
            let to = match j {
                _ if 2 * j == count => middle,
                _ if j == count => *back,
                _ => self.fine.look_up(simd, s0 + part * splat(simd, j as f32)),
            };
            let light = lights[usize::from(2 * j > count)];
            composite(simd, pixels, mean_between(simd, &from, &to, part), thickness, light);
            if self.are_closed(simd, pixels[3]) {
                break;
            }
            from = to;
        }
        })
    }

    /// The same where scalars stand for others within a `spread` of them.
    #[inline(never)]
    pub(crate) fn add_spread<S: Simd>(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        cell: &Cell<S>,
        spread: f32x8<S>,
        halfway: [f32x8<S>; 3],
    ) {
        outlined!(simd => {
        let [s0, s1] = cell.scalars;
        let whole = self.fine.mean_around(simd, cell.scalars, spread);
        if !whole[3].simd_gt(splat(simd, 0.0)).any_true() {
            return;
        }
        let ends = [self.fine.value_at(simd, s0), whole, self.fine.value_at(simd, s1)];
        if self.is_one(simd, ends, cell.thickness, pixels[3]) {
            composite(simd, pixels, whole, cell.thickness, self.light_halfway(simd, cell.gradient, halfway));
            return;
        }
        let middle = splat(simd, 0.5) * (s0 + s1);
        let a = self.fine.mean_around(simd, [s0, middle], spread);
        let b = self.fine.mean_around(simd, [middle, s1], spread);
        let lights = self.lights(simd, cell.gradient, halfway);
        let thickness = splat(simd, 0.5) * cell.thickness;
        let parts = self.parts(simd, (a, b), thickness, pixels[3]);
        if parts <= 1.0 {
            composite(simd, pixels, a, thickness, lights[0]);
            composite(simd, pixels, b, thickness, lights[1]);
            return;
        }
        let count = 2 * parts as u32;
        let share = 1.0 / count as f32;
        let part = (s1 - s0) * splat(simd, share);
        let thickness = cell.thickness * splat(simd, share);
        for j in 0..count {
            let ends = [s0 + part * splat(simd, j as f32), s0 + part * splat(simd, (j + 1) as f32)];
            let light = lights[usize::from(2 * j >= count)];
            composite(simd, pixels, self.fine.mean_around(simd, ends, spread), thickness, light);
            if self.are_closed(simd, pixels[3]) {
                break;
            }
        }
        })
    }

    /// Whether a cell may be composited at once: whether the order of what it shows in front, in the mean and behind matters to
    /// none of its rays.
    #[inline(always)]
    pub(crate) fn is_one<S: Simd>(
        &self,
        simd: S,
        ends: [[f32x8<S>; 4]; 3],
        thickness: f32x8<S>,
        visible: f32x8<S>,
    ) -> bool {
        let worst = disorder(simd, ends, thickness) * visible;
        largest(worst) <= self.tolerance
    }

    /// The light in the middle of a cell, where any falls.
    #[inline(always)]
    fn light_halfway<S: Simd>(
        &self,
        simd: S,
        gradient: Option<[[f32x8<S>; 2]; 3]>,
        halfway: [f32x8<S>; 3],
    ) -> Option<Light<S>> {
        let ends = gradient?;
        Some(self.light(simd, middle_of(simd, ends), halfway))
    }

    /// Parts of half a cell that the order of what it shows asks for, the most of all eight.
    #[inline(always)]
    pub(crate) fn parts<S: Simd>(
        &self,
        simd: S,
        (a, b): ([f32x8<S>; 4], [f32x8<S>; 4]),
        thickness: f32x8<S>,
        visible: f32x8<S>,
    ) -> f32 {
        let order = each!(c of 3 => (a[c] * b[3] - b[c] * a[3]).abs());
        let order = order[0].max(order[1]).max(order[2]);
        let depth = (a[3] + b[3]) * thickness;
        let worst = order * thickness * thickness * visible / (splat(simd, 1.0) + depth * depth);
        let (errors, depths) = ((worst / splat(simd, self.tolerance)).to_array(), depth.to_array());
        if largest(worst) <= self.tolerance {
            return 1.0;
        }
        (0..LANES).map(|lane| parts_by_errors(errors[lane], depths[lane], MOST_PARTS)).fold(1.0, f32::max)
    }

    /// Whether what follows adds nothing to any of eight pixels.
    #[inline(always)]
    pub(crate) fn are_closed<S: Simd>(&self, simd: S, visible: f32x8<S>) -> bool {
        visible.simd_lt(splat(simd, self.casting.scene.termination)).all_true()
    }

    /// The light on each half of a cell, where any falls.
    #[inline(always)]
    fn lights<S: Simd>(
        &self,
        simd: S,
        gradient: Option<[[f32x8<S>; 2]; 3]>,
        halfway: [f32x8<S>; 3],
    ) -> [Option<Light<S>>; 2] {
        let Some(ends) = gradient else { return [None; 2] };
        let near = each!(axis of 3 => ends[axis][0] + (ends[axis][1] - ends[axis][0]) * splat(simd, 0.25));
        let far = each!(axis of 3 => ends[axis][0] + (ends[axis][1] - ends[axis][0]) * splat(simd, 0.75));
        [Some(self.light(simd, near, halfway)), Some(self.light(simd, far, halfway))]
    }

    /// See `twin::shade::Phong`.
    #[inline(always)]
    pub(crate) fn light<S: Simd>(
        &self,
        simd: S,
        gradient: [f32x8<S>; 3],
        halfway: [f32x8<S>; 3],
    ) -> Light<S> {
        let direction = self.direction(simd, gradient);
        Light {
            body: self.body_of(simd, gradient, direction),
            highlight: self.highlight_of(simd, gradient, direction, halfway),
        }
    }

    /// What light makes of colours but for the highlight.
    #[inline(always)]
    pub(crate) fn body<S: Simd>(&self, simd: S, gradient: [f32x8<S>; 3]) -> f32x8<S> {
        self.body_of(simd, gradient, self.direction(simd, gradient))
    }

    /// The highlight, as a share of the extinction.
    #[inline(always)]
    pub(crate) fn highlight<S: Simd>(
        &self,
        simd: S,
        gradient: [f32x8<S>; 3],
        halfway: [f32x8<S>; 3],
    ) -> f32x8<S> {
        self.highlight_of(simd, gradient, self.direction(simd, gradient), halfway)
    }

    #[inline(always)]
    fn direction<S: Simd>(&self, simd: S, gradient: [f32x8<S>; 3]) -> Direction<S> {
        let square = dot(gradient, gradient);
        let has_direction = square.simd_ge(splat(simd, LEAST_SQUARE as f32));
        let per_length = splat(simd, 1.0) / has_direction.select(square, splat(simd, 1.0)).sqrt();
        let weight = square / (square + splat(simd, self.casting.scene.gradient_half_square));
        Direction { per_length, weight: has_direction.select(weight, splat(simd, 0.0)) }
    }

    #[inline(always)]
    fn body_of<S: Simd>(&self, simd: S, gradient: [f32x8<S>; 3], direction: Direction<S>) -> f32x8<S> {
        let Direction { per_length, weight } = direction;
        let scene = self.casting.scene;
        let toward_light = each!(axis of 3 => splat(simd, scene.toward_light.0[axis]));
        let lit = dot(gradient, toward_light).abs() * per_length;
        let [ambient, diffuse, ..] = scene.material;
        splat(simd, 1.0) - weight + weight * (splat(simd, ambient) + splat(simd, diffuse) * lit)
    }

    #[inline(always)]
    fn highlight_of<S: Simd>(
        &self,
        simd: S,
        gradient: [f32x8<S>; 3],
        direction: Direction<S>,
        halfway: [f32x8<S>; 3],
    ) -> f32x8<S> {
        let [_, _, specular, shininess] = self.casting.scene.material;
        if specular <= 0.0 {
            return splat(simd, 0.0);
        }
        let Direction { per_length, weight } = direction;
        let cosine = (dot(gradient, halfway).abs() * per_length).min(splat(simd, 1.0));
        weight * splat(simd, specular) * power(simd, cosine, splat(simd, shininess))
    }
}

/// How much the order of what a cell shows in front, in the mean and behind matters, as light.
#[inline(always)]
pub(crate) fn disorder<S: Simd>(
    simd: S,
    [near, mean, far]: [[f32x8<S>; 4]; 3],
    thickness: f32x8<S>,
) -> f32x8<S> {
    let a = each!(c of 3 => (near[c] * mean[3] - mean[c] * near[3]).abs());
    let b = each!(c of 3 => (mean[c] * far[3] - far[c] * mean[3]).abs());
    let order = a[0].max(a[1]).max(a[2]) + b[0].max(b[1]).max(b[2]);
    let depth = mean[3] * thickness;
    splat(simd, 0.125) * order * thickness * thickness / (splat(simd, 1.0) + depth * depth)
}

/// The gradient half-way between two ends.
#[inline(always)]
pub(crate) fn middle_of<S: Simd>(simd: S, ends: [[f32x8<S>; 2]; 3]) -> [f32x8<S>; 3] {
    each!(axis of 3 => (ends[axis][0] + ends[axis][1]) * splat(simd, 0.5))
}

#[inline(always)]
fn dot<S: Simd>(a: [f32x8<S>; 3], b: [f32x8<S>; 3]) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn composite<S: Simd>(
    simd: S,
    pixels: &mut Pixels<S>,
    k: [f32x8<S>; 4],
    thickness: f32x8<S>,
    light: Option<Light<S>>,
) {
    let depth = k[3] * thickness;
    let share = attenuation_mean(simd, depth);
    let through = share * thickness * pixels[3];
    match light {
        None => {
            pixels[0] += k[0] * through;
            pixels[1] += k[1] * through;
            pixels[2] += k[2] * through;
        }
        Some(Light { body, highlight }) => {
            let white = k[3] * highlight;
            pixels[0] += (k[0] * body + white) * through;
            pixels[1] += (k[1] * body + white) * through;
            pixels[2] += (k[2] * body + white) * through;
        }
    }
    // Cells wait for each other by this alone.
    pixels[3] *= splat(simd, 1.0) - depth * share;
}
