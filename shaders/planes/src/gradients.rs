//! Gradients between those that are taken of the volume.

use crate::slab::{LANES, Slab};
use lanes::*;

/// At how many columns and depths a gradient is taken once, where samples lie at a spacing: no closer than a quarter of a voxel, so
/// many times halved, as differences over two voxels change little within that.
pub(crate) const fn gradients_every(spacing: usize, halvings: usize) -> usize {
    1 << spacing.saturating_sub(2 + halvings)
}

/// Gives a block's samples gradients between those taken `every` so many columns and depths.
#[inline(always)]
pub(crate) fn spread_gradients<S: Simd>(simd: S, slab: &mut Slab, block: usize, every: usize) {
    let cells = slab.cells();
    let mut before = 0;
    for depth in 0..=cells {
        if !depth.is_multiple_of(every) && depth != cells {
            continue;
        }
        let shows_behind = slab.shows(block, [depth, (depth + every).min(cells)]);
        let shows_in_front = slab.shows(block, [depth.saturating_sub(every), depth]);
        if shows_in_front || shows_behind {
            for phase in (0..slab.phases).filter(|phase| !phase.is_multiple_of(every)) {
                let first = phase - phase % every;
                let next = slab.step(first, every);
                let ends = [(depth, first, 0), (depth, next.0, next.1)];
                let share = (phase % every) as f32 / every as f32;
                for level in 0..slab.gradient_rows / 3 {
                    put_between(simd, slab, (block, level), ends, (depth, phase), share);
                }
            }
        }
        if shows_in_front {
            for between in before + 1..depth {
                let share = (between - before) as f32 / (depth - before) as f32;
                for phase in 0..slab.phases {
                    let ends = [(before, phase, 0), (depth, phase, 0)];
                    for level in 0..slab.gradient_rows / 3 {
                        put_between(simd, slab, (block, level), ends, (between, phase), share);
                    }
                }
            }
        }
        before = depth;
    }
}

/// Eight gradients of a level that lie a `share` of the way from some to others, each of a depth, a phase, and so many entries further. Where
/// only one of both is known, it serves.
#[inline(always)]
fn put_between<S: Simd>(
    simd: S,
    slab: &mut Slab,
    (block, level): (usize, usize),
    ends: [(usize, usize, usize); 2],
    (depth, phase): (usize, usize),
    share: f32,
) {
    let at = (block, level);
    let (a, b) = (gradient(simd, slab, at, ends[0]), gradient(simd, slab, at, ends[1]));
    let (has_a, has_b) = (has_direction(simd, a), has_direction(simd, b));
    let start = slab.gradient_start(depth, phase, level) + block * LANES;
    for axis in 0..3 {
        let (from, to) = (has_a.select(a[axis], b[axis]), has_b.select(b[axis], a[axis]));
        let at = start + axis * slab.stride;
        (from + (to - from) * splat(simd, share)).store_slice(&mut slab.gradients[at..at + LANES]);
    }
}

#[inline(always)]
fn gradient<S: Simd>(
    simd: S,
    slab: &Slab,
    (block, level): (usize, usize),
    (depth, phase, further): (usize, usize, usize),
) -> [f32x8<S>; 3] {
    let start = slab.gradient_start(depth, phase, level) + block * LANES + further;
    each!(axis of 3 => load(simd, &slab.gradients, start + axis * slab.stride))
}

#[inline(always)]
fn has_direction<S: Simd>(simd: S, gradient: [f32x8<S>; 3]) -> mask32x8<S> {
    let most = gradient[0].abs().max(gradient[1].abs()).max(gradient[2].abs());
    most.simd_gt(splat(simd, 0.0))
}
