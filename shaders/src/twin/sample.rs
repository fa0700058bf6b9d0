//! The stored sample at a point of a brick: the twin of `wgsl/sample/exact.wgsl`. The texture unit has no twin.

use super::{Real, scene::BRICK_VOXELS, vector::Vec3};

/// Stored samples along an edge.
const EDGE: u32 = 32;
/// Samples to the next along y and along z.
const ROW: usize = 32;
const LAYER: usize = 32 * 32;

/// `point` in texels of the brick, sample centres at integer + 0.5, from 0.5 to 31.5; the result is in [0, 1].
#[inline(always)]
pub fn sample_brick<F: Real>(brick: &[u16; BRICK_VOXELS], point: Vec3<F>) -> F {
    let half = F::of(0.5);
    let mut index = [0; 3];
    let mut f = [F::ZERO; 3];
    for axis in 0..3 {
        let shifted = point.0[axis] - half;
        index[axis] = shifted.to_index().min(EDGE - 2);
        f[axis] = shifted - F::of_u32(index[axis]);
    }
    let base = ((index[2] * EDGE + index[1]) * EDGE + index[0]) as usize;
    // One bounds check for all eight; neighbours along x come as one word.
    let window = &brick[base..base + LAYER + ROW + 2];
    let pair = |offset: usize| u32::from(window[offset]) | u32::from(window[offset + 1]) << 16;
    let pairs = [pair(0), pair(ROW), pair(LAYER), pair(LAYER + ROW)];
    let low: [F; 4] = std::array::from_fn(|c| F::of_u32(pairs[c] & 0xffff));
    let high: [F; 4] = std::array::from_fn(|c| F::of_u32(pairs[c] >> 16));
    let along_x: [F; 4] = std::array::from_fn(|c| low[c] + (high[c] - low[c]) * f[0]);
    let along_y =
        [along_x[0] + (along_x[1] - along_x[0]) * f[1], along_x[2] + (along_x[3] - along_x[2]) * f[1]];
    (along_y[0] + (along_y[1] - along_y[0]) * f[2]) * F::of(1.0 / 65535.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_field_is_met_exactly_everywhere() {
        let codes: Vec<u16> = (0..BRICK_VOXELS).map(|i| (i % 32 + 32 * (i / 32 % 32) * 2) as u16).collect();
        let brick = codes.first_chunk().unwrap();
        for (x, y, z) in [(0.5, 0.5, 0.5), (31.5, 31.5, 31.5), (7.25, 19.875, 3.0)] {
            let truth = ((x - 0.5) + 64.0 * (y - 0.5)) / 65535.0;
            let found: f64 = sample_brick(brick, Vec3([x, y, z]));
            assert!((found - truth).abs() < 1e-12, "{found} for {truth}");
        }
    }
}
