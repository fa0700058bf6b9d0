//! The stored sample at a point of a brick: the twin of `wgsl/sample/quads.wgsl`. The texture unit has no twin.

use super::four::{between_corners, each, mix};
use super::{Real, vector::Vec3};
use layout::brick::{self, VOXELS};

/// Stored samples along an edge.
pub(super) const EDGE: u32 = brick::EDGE as u32;
/// Samples to the next along y and along z.
pub(super) const ROW: usize = brick::EDGE;
pub(super) const LAYER: usize = brick::EDGE * brick::EDGE;

/// A point's lowest neighbour, and how far it lies from there along each axis.
#[inline(always)]
fn place<F: Real>(point: Vec3<F>, lowest: u32, highest: u32) -> (usize, [F; 3]) {
    let half = F::of(0.5);
    let [x, y, z] = [point.0[0] - half, point.0[1] - half, point.0[2] - half];
    let clamp = |shifted: F| shifted.to_index().min(highest).max(lowest);
    let (i, j, k) = (clamp(x), clamp(y), clamp(z));
    let f = [x - F::of_u32(i), y - F::of_u32(j), z - F::of_u32(k)];
    (((k * EDGE + j) * EDGE + i) as usize, f)
}

/// Two neighbours along x as one word: the nearer in the low half.
#[inline(always)]
pub(super) fn pair(window: &[u16], offset: usize) -> u32 {
    u32::from(window[offset]) | u32::from(window[offset + 1]) << 16
}

#[inline(always)]
fn low<F: Real>(word: u32) -> F {
    F::of_u32(word & 0xffff)
}

#[inline(always)]
fn high<F: Real>(word: u32) -> F {
    F::of_u32(word >> 16)
}

/// What a sample of 65535 is to the codes' sum.
pub(super) const PER_CODE: f64 = 1.0 / 65535.0;
/// The same for deviations.
pub(super) const PER_DEVIATION: f64 = 1.0 / 255.0;

/// `point` in texels of the brick, sample centres at integer + 0.5, from 0.5 to 31.5; the result is in [0, 1].
#[inline(always)]
pub fn sample_brick<F: Real>(brick: &[u16; VOXELS], point: Vec3<F>) -> F {
    let (base, f) = place(point, 0, EDGE - 2);
    // One bounds check for all eight.
    let window = &brick[base..base + LAYER + ROW + 2];
    let pairs = [pair(window, 0), pair(window, ROW), pair(window, LAYER), pair(window, LAYER + ROW)];
    let along_x = mix(each!(C => low(pairs[C])), each!(C => high(pairs[C])), f[0]);
    between_corners(along_x, f[1], f[2]) * F::of(PER_CODE)
}

/// The deviation at `point`, in [0, 1]: see `wgsl/spread/level.wgsl`.
#[inline(always)]
pub fn sample_deviations<F: Real>(brick: &[u8; VOXELS], point: Vec3<F>) -> F {
    let (base, f) = place(point, 0, EDGE - 2);
    let window = &brick[base..base + LAYER + ROW + 2];
    let texel = |i: usize| F::of_u32(u32::from(window[i]));
    let low = [texel(0), texel(ROW), texel(LAYER), texel(LAYER + ROW)];
    let high = [texel(1), texel(ROW + 1), texel(LAYER + 1), texel(LAYER + ROW + 1)];
    between_corners(mix(low, high, f[0]), f[1], f[2]) * F::of(PER_DEVIATION)
}

/// Differences of the samples one texel ahead and one behind, along each axis; `point` from 1.5 to 30.5. The same as six
/// samples: neighbours a whole texel apart share their weights, so codes are subtracted before they are weighed.
#[inline(always)]
pub fn differences<F: Real>(brick: &[u16; VOXELS], point: Vec3<F>) -> Vec3<F> {
    let (base, f) = place(point, 1, EDGE - 3);
    let first = base - LAYER - ROW - 1;
    let window = &brick[first..first + 3 * LAYER + 3 * ROW + 4];
    // Row (j, k) of the 4 × 4 around the point, each from −1 to 2, at its nearer x neighbours.
    let row = |j: usize, k: usize| pair(window, k * LAYER + j * ROW + 1);
    let behind = |j: usize, k: usize| F::of_u32(u32::from(window[k * LAYER + j * ROW]));
    let ahead = |j: usize, k: usize| F::of_u32(u32::from(window[k * LAYER + j * ROW + 3]));
    let inner = [row(1, 1), row(2, 1), row(1, 2), row(2, 2)];
    let near: [F; 4] = each!(C => low(inner[C]));
    let far: [F; 4] = each!(C => high(inner[C]));
    let back = [behind(1, 1), behind(2, 1), behind(1, 2), behind(2, 2)];
    let front = [ahead(1, 1), ahead(2, 1), ahead(1, 2), ahead(2, 2)];
    let x = mix(each!(C => far[C] - back[C]), each!(C => front[C] - near[C]), f[0]);
    // Along y and z the corners are (x, the other axis): 00, 10, 01, 11.
    let y_back = [row(0, 1), row(0, 2)];
    let y_front = [row(3, 1), row(3, 2)];
    let y_near = [inner[0], inner[2]];
    let y_far = [inner[1], inner[3]];
    let y = mix(ahead_less_behind(y_far, y_back), ahead_less_behind(y_front, y_near), f[1]);
    let z_back = [row(1, 0), row(2, 0)];
    let z_front = [row(1, 3), row(2, 3)];
    let z_near = [inner[0], inner[1]];
    let z_far = [inner[2], inner[3]];
    let z = mix(ahead_less_behind(z_far, z_back), ahead_less_behind(z_front, z_near), f[2]);
    let scale = F::of(PER_CODE);
    Vec3([
        between_corners(x, f[1], f[2]) * scale,
        between_corners(y, f[0], f[2]) * scale,
        between_corners(z, f[0], f[1]) * scale,
    ])
}

/// Differences of two pairs of neighbours along x: corners 00, 10, 01, 11.
#[inline(always)]
fn ahead_less_behind<F: Real>(ahead: [u32; 2], behind: [u32; 2]) -> [F; 4] {
    [
        low::<F>(ahead[0]) - low(behind[0]),
        high::<F>(ahead[0]) - high(behind[0]),
        low::<F>(ahead[1]) - low(behind[1]),
        high::<F>(ahead[1]) - high(behind[1]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_field_is_met_exactly_everywhere() {
        let codes: Vec<u16> = (0..VOXELS).map(|i| (i % 32 + 32 * (i / 32 % 32) * 2) as u16).collect();
        let brick = codes.first_chunk().unwrap();
        for (x, y, z) in [(0.5, 0.5, 0.5), (31.5, 31.5, 31.5), (7.25, 19.875, 3.0)] {
            let truth = ((x - 0.5) + 64.0 * (y - 0.5)) / 65535.0;
            let found: f64 = sample_brick(brick, Vec3([x, y, z]));
            assert!((found - truth).abs() < 1e-12, "{found} for {truth}");
        }
    }

    #[test]
    fn differences_are_those_of_six_samples() {
        let codes: Vec<u16> =
            (0..VOXELS as u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 16) as u16).collect();
        let brick = codes.first_chunk().unwrap();
        for (x, y, z) in [(1.5, 1.5, 1.5), (30.5, 30.5, 30.5), (7.25, 19.875, 3.0), (16.1, 2.9, 29.7)] {
            let found = differences::<f64>(brick, Vec3([x, y, z]));
            for axis in 0..3 {
                let mut unit = [0.0; 3];
                unit[axis] = 1.0;
                let [ahead, behind] =
                    [1.0, -1.0].map(|s| sample_brick(brick, Vec3([x, y, z]) + Vec3(unit) * s));
                assert!((found.0[axis] - (ahead - behind)).abs() < 1e-12, "{axis} at {x} {y} {z}");
            }
        }
    }
}
