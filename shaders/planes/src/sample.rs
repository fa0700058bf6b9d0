//! Samples of one level of detail, eight columns at once; see `twin::levels::Level`.

use crate::slab::LANES;
use lanes::*;
use layout::brick;
use twin::levels::Level;

const EDGE: usize = brick::EDGE;
/// Samples to the next along y and along z.
const ROW: usize = EDGE;
const LAYER: usize = EDGE * EDGE;

/// Eight points' lowest neighbours in a brick, and how far they lie from there along each axis.
#[inline(always)]
fn place<S: Simd>(
    simd: S,
    texels: [f32x8<S>; 3],
    [lowest, highest]: [usize; 2],
) -> ([usize; LANES], [f32x8<S>; 3]) {
    let half = splat(simd, 0.5);
    let (least, most) = (splat(simd, lowest as f32), splat(simd, highest as f32));
    let at = each!(axis of 3 => texels[axis] - half);
    let low = each!(axis of 3 => at[axis].floor().max(least).min(most));
    let part = each!(axis of 3 => at[axis] - low[axis]);
    let edge = splat(simd, EDGE as f32);
    let base: i32x8<S> = ((low[2] * edge + low[1]) * edge + low[0]).to_int();
    let base = base.to_array();
    // Within the brick, as its corners are.
    let [first, last] = [lowest, highest].map(|index| index * (LAYER + ROW + 1));
    (eight!(LANE => (base[LANE] as usize).clamp(first, last)), part)
}

/// Where eight columns at these x on a level's line lie in its brick.
#[inline(always)]
pub(crate) fn texels_at<S: Simd>(simd: S, level: &Level<f32>, x: f32x8<S>) -> [f32x8<S>; 3] {
    let origin = level.point(0.0);
    each!(axis of 3 => splat(simd, origin.0[axis]) + splat(simd, level.slope.0[axis]) * x)
}

/// What a brick's codes are at eight points.
#[inline(always)]
fn codes_in<S: Simd, C: Copy + Into<i32>>(
    simd: S,
    codes: &[C; brick::VOXELS],
    texels: [f32x8<S>; 3],
) -> f32x8<S> {
    let (base, part) = place(simd, texels, [0, EDGE - 2]);
    let mut pairs = [[0i32; LANES]; 4];
    for lane in 0..LANES {
        let window = &codes[base[lane]..base[lane] + LAYER + ROW + 2];
        pairs[0][lane] = pair(window, 0);
        pairs[1][lane] = pair(window, ROW);
        pairs[2][lane] = pair(window, LAYER);
        pairs[3][lane] = pair(window, LAYER + ROW);
    }
    let along_x = each!(i of 4 => {
        let [near, far] = halves(simd, pairs[i]);
        near + (far - near) * part[0]
    });
    between(along_x, part[1], part[2])
}

/// The scalars at eight points of a level's brick.
#[inline(always)]
pub(crate) fn scalars_in<S: Simd>(simd: S, level: &Level<f32>, texels: [f32x8<S>; 3]) -> f32x8<S> {
    let [offset, scale] = level.code_range();
    let scalar = splat(simd, offset) + splat(simd, scale / 65535.0) * codes_in(simd, level.codes, texels);
    scalar.max(splat(simd, 0.0)).min(splat(simd, 1.0))
}

/// The standard deviations at eight points of a level's brick; 0 where samples stand for themselves.
#[inline(always)]
pub(crate) fn spreads_in<S: Simd>(simd: S, level: &Level<f32>, texels: [f32x8<S>; 3]) -> f32x8<S> {
    match level.deviations {
        Some((codes, scale)) => splat(simd, scale / 255.0) * codes_in(simd, codes, texels),
        None => splat(simd, 0.0),
    }
}

/// Differences over two texels at eight points of a level's brick, per finest voxel; see `twin::sample::differences`.
#[inline(always)]
pub(crate) fn gradients_in<S: Simd>(simd: S, level: &Level<f32>, texels: [f32x8<S>; 3]) -> [f32x8<S>; 3] {
    let (base, part) = place(simd, texels, [1, EDGE - 3]);
    // Of the 4 × 4 × 4 around a point: rows (j, k) of the inner 2 × 2 whole, then their neighbours along y and along z.
    let mut inner = [[[0i32; LANES]; 2]; 4];
    let mut beside = [[[0i32; LANES]; 4]; 2];
    for lane in 0..LANES {
        let first = base[lane] - LAYER - ROW - 1;
        let window = &level.codes[first..first + 3 * LAYER + 3 * ROW + 4];
        for corner in 0..4 {
            let start = (1 + corner / 2) * LAYER + (1 + corner % 2) * ROW;
            inner[corner][0][lane] = pair(window, start);
            inner[corner][1][lane] = pair(window, start + 2);
            let (end, other) = (3 * (corner % 2), 1 + corner / 2);
            beside[0][corner][lane] = pair(window, other * LAYER + end * ROW + 1);
            beside[1][corner][lane] = pair(window, end * LAYER + other * ROW + 1);
        }
    }
    let rows = each!(corner of 4 => {
        let [a, b] = halves(simd, inner[corner][0]);
        let [c, d] = halves(simd, inner[corner][1]);
        [a, b, c, d]
    });
    let x = each!(corner of 4 => {
        let [a, b, c, d] = rows[corner];
        (c - a) + ((d - b) - (c - a)) * part[0]
    });
    // Corners (x, the other axis): behind and ahead of both inner rows along the axis.
    let sides = each!(corner of 4 => halves(simd, beside[0][corner]));
    let y = each!(corner of 4 => {
        let (side, k) = (corner % 2, corner / 2);
        let [near, far] = [rows[2 * k][1 + side], rows[2 * k + 1][1 + side]];
        let (low, high) = (far - sides[2 * k][side], sides[2 * k + 1][side] - near);
        low + (high - low) * part[1]
    });
    let sides = each!(corner of 4 => halves(simd, beside[1][corner]));
    let z = each!(corner of 4 => {
        let (side, j) = (corner % 2, corner / 2);
        let [near, far] = [rows[j][1 + side], rows[2 + j][1 + side]];
        let (low, high) = (far - sides[2 * j][side], sides[2 * j + 1][side] - near);
        low + (high - low) * part[2]
    });
    let scale = splat(simd, level.gradient_scale / 65535.0);
    [
        between(x, part[1], part[2]) * scale,
        between(y, part[0], part[2]) * scale,
        between(z, part[0], part[1]) * scale,
    ]
}

/// Between four corners: along one axis, then along the other.
#[inline(always)]
fn between<S: Simd>(corners: [f32x8<S>; 4], first: f32x8<S>, second: f32x8<S>) -> f32x8<S> {
    let near = corners[0] + (corners[1] - corners[0]) * first;
    let far = corners[2] + (corners[3] - corners[2]) * first;
    near + (far - near) * second
}

/// Two neighbours along x as one word, the nearer in the low half.
#[inline(always)]
fn pair<C: Copy + Into<i32>>(window: &[C], offset: usize) -> i32 {
    window[offset].into() | window[offset + 1].into() << 16
}
