//! A cell that is too steep for means: what one view's ray meets there.

use crate::classify::mean;
use twin::Casting;
use twin::gradient::Gradients;
use twin::ray::{Ray, far};
use twin::refine::parts_by_errors;
use twin::shade::{Lighting, Phong, Shade};
use twin::tables::{attenuation_mean, is_vacant_around, locate};
use twin::vector::Vec3;

/// Parts of half a cell, at most, unless they are opaque.
const MOST_PARTS: f32 = 64.0;

/// What a ray meets between two depths.
#[derive(Clone, Copy)]
pub(crate) struct Met {
    pub(crate) scalars: (f32, f32),
    pub(crate) spread: f32,
    /// Optical depth where the table says 1.
    pub(crate) thickness: f32,
    /// Half-way, where light falls.
    pub(crate) gradient: Option<[f32; 3]>,
}

/// Adds a cell to premultiplied colour and how much of the light from behind gets through.
#[inline(always)]
pub(crate) fn add(casting: &Casting<f32>, pixel: &mut [f32; 4], met: &Met, direction: [f32; 3]) {
    let tables = casting.tables;
    let (s0, s1) = met.scalars;
    if is_vacant_around(&tables.cells, (s0.min(s1), s0.max(s1)), met.spread) {
        return;
    }
    let s_mid = 0.5 * (s0 + s1);
    let (front, middle, back) = (locate(tables, s0), locate(tables, s_mid), locate(tables, s1));
    let a = mean(casting, [&front, &middle], (s0, s_mid), met.spread);
    let b = mean(casting, [&middle, &back], (s_mid, s1), met.spread);
    let half = 0.5 * met.thickness;
    let light = match met.gradient {
        Some(gradient) if a[3].max(b[3]) > 0.0 => lighting(casting, gradient, direction),
        _ => Lighting::NONE,
    };
    let visible = pixel[3];
    let depth = (a[3] + b[3]) * half;
    let order = (0..3).map(|c| (a[c] * b[3] - b[c] * a[3]).abs()).fold(0.0, f32::max);
    let worst = order * half * half / (1.0 + depth * depth) * visible;
    let parts = parts_by_errors(worst / casting.scene.tolerance, depth, MOST_PARTS);
    if parts <= 1.0 {
        composite(pixel, a, half, &light);
        composite(pixel, b, half, &light);
        return;
    }
    let count = 2 * parts as u32;
    let share = 1.0 / count as f32;
    let mut from = (s0, front);
    for j in 1..=count {
        let s = if j == count { s1 } else { s0 + (s1 - s0) * (j as f32 * share) };
        let to = (s, locate(tables, s));
        let k = mean(casting, [&from.1, &to.1], (from.0, s), met.spread);
        composite(pixel, k, met.thickness * share, &light);
        if pixel[3] < casting.scene.termination {
            return;
        }
        from = to;
    }
}

#[inline(always)]
fn composite(pixel: &mut [f32; 4], k: [f32; 4], thickness: f32, light: &Lighting<f32>) {
    let depth = k[3] * thickness;
    let mean = attenuation_mean(depth);
    for c in 0..3 {
        let lit = k[c] * light.body + k[3] * light.highlight;
        pixel[c] += pixel[3] * (lit * (thickness * mean));
    }
    pixel[3] *= 1.0 - depth * mean;
}

#[inline(always)]
fn lighting(casting: &Casting<f32>, gradient: [f32; 3], direction: [f32; 3]) -> Lighting<f32> {
    let gradients = Gradients { at: Vec3(gradient), ..Gradients::NONE };
    let ray = Ray {
        origin_in_volume: Vec3::ZERO,
        direction_in_volume: Vec3::ZERO,
        inverse: Vec3::ZERO,
        origin_in_display: Vec3::ZERO,
        direction_in_display: Vec3(direction),
        start: 0.0,
        end: far(),
        speed: 0.0,
    };
    Phong::lighting(casting, &gradients, &ray, casting.scene.material)
}
