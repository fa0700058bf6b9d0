//! Samples of one level of detail, eight columns at once; see `twin::levels::Level`.

use crate::slab::LANES;
use lanes::*;
use layout::brick;
use twin::levels::Level;

const EDGE: usize = brick::EDGE;
/// Samples to the next along y and along z.
const ROW: usize = EDGE;
const LAYER: usize = EDGE * EDGE;

/// The scalars of eight columns at these x on a level's line.
#[inline(always)]
pub(crate) fn scalars_at<S: Simd>(simd: S, level: &Level<f32>, x: f32x8<S>) -> f32x8<S> {
    let origin = level.point(0.0);
    let half = splat(simd, 0.5);
    let highest = splat(simd, (EDGE - 2) as f32);
    let zero = splat(simd, 0.0);
    let at = each!(axis of 3 => splat(simd, origin.0[axis]) + splat(simd, level.slope.0[axis]) * x - half);
    let low = each!(axis of 3 => at[axis].floor().max(zero).min(highest));
    let part = each!(axis of 3 => at[axis] - low[axis]);
    let edge = splat(simd, EDGE as f32);
    let base: i32x8<S> = ((low[2] * edge + low[1]) * edge + low[0]).to_int();
    let base = base.to_array();
    let mut pairs = [[0i32; LANES]; 4];
    for lane in 0..LANES {
        // Within the brick, as its highest corner is.
        let start = (base[lane] as usize).min(brick::VOXELS - LAYER - ROW - 2);
        let window = &level.codes[start..start + LAYER + ROW + 2];
        pairs[0][lane] = pair(window, 0);
        pairs[1][lane] = pair(window, ROW);
        pairs[2][lane] = pair(window, LAYER);
        pairs[3][lane] = pair(window, LAYER + ROW);
    }
    let along_x = each!(i of 4 => {
        let [near, far] = halves(simd, pairs[i]);
        near + (far - near) * part[0]
    });
    let near = along_x[0] + (along_x[1] - along_x[0]) * part[1];
    let far = along_x[2] + (along_x[3] - along_x[2]) * part[1];
    let [offset, scale] = level.code_range();
    let scalar = splat(simd, offset) + splat(simd, scale / 65535.0) * (near + (far - near) * part[2]);
    scalar.max(zero).min(splat(simd, 1.0))
}

/// Two neighbours along x as one word, the nearer in the low half.
#[inline(always)]
fn pair(window: &[u16], offset: usize) -> i32 {
    i32::from(window[offset]) | i32::from(window[offset + 1]) << 16
}
