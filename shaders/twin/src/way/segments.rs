//! Segments of eight rays side by side: where their scalars lie in the tables, and the means between.

use crate::real::Number;
use crate::spread::with_outside;
use crate::tables::{Located, locate_in, optics_between_by};
use lanes::*;
use needs::tables::{TABLE_CELLS, Tables};

/// Rays side by side.
pub(crate) const RAYS: usize = 8;

/// Takes the first of a set of rays out of it.
#[inline(always)]
pub(super) fn first_of(rays: &mut u64) -> usize {
    let lane = rays.trailing_zeros() as usize % RAYS;
    *rays &= *rays - 1;
    lane
}

/// Where scalars lie in the tables.
pub(super) struct Places<S: Simd> {
    u: f32x8<S>,
    pub(super) cell: i32x8<S>,
    part: f32x8<S>,
}

impl<S: Simd> Places<S> {
    #[inline(always)]
    pub(super) fn of(s: f32x8<S>) -> Self {
        let u = s * s.alike(TABLE_CELLS as f64);
        let cell: i32x8<S> = u.to_int();
        let cell = cell.min(i32x8::splat(s.token(), TABLE_CELLS as i32 - 1));
        let low: f32x8<S> = cell.to_float();
        Self { u, cell, part: u - low }
    }

    /// What the tables say of a ray's scalar.
    #[inline(always)]
    fn locate(&self, tables: &Tables, lane: usize) -> Located<f32> {
        locate_in(tables, self.u[lane], self.cell[lane] as usize, self.part[lane])
    }
}

/// Where a segment's scalars lie in the tables.
pub(super) struct Segment<S: Simd> {
    ends: [Places<S>; 2],
    /// What its width divides by.
    per_width: f32x8<S>,
    /// Widths below 0, above 1 and of all, where its samples stand for others: all 0 elsewhere.
    outside: [f32x8<S>; 3],
}

impl<S: Simd> Segment<S> {
    #[inline(always)]
    pub(super) fn between([a, b]: [f32x8<S>; 2]) -> Self {
        let zero = a.alike(0.0);
        let ends = [Places::of(a), Places::of(b)];
        let per_width = a.alike(1.0) / Number::abs(ends[1].u - ends[0].u);
        Self { ends, per_width, outside: [zero; 3] }
    }

    /// The same where each of its scalars stands for those within `spread` of it: see `spread::optics_over`.
    #[inline(always)]
    pub(super) fn over([a, b]: [f32x8<S>; 2], spread: f32x8<S>) -> Self {
        let (zero, half, one) = (a.alike(0.0), a.alike(0.5), a.alike(1.0));
        let along = half * (b - a);
        let reach = Number::sqrt(along * along + spread * spread);
        let middle = half * (a + b);
        let (from, to) = (middle - reach, middle + reach);
        let is_wide = spread.simd_gt(zero);
        let ends = [is_wide.select(from.most(zero), a), is_wide.select(to.least(one), b)];
        let outside = [(-from).most(zero), (to - one).most(zero), a.alike(2.0) * reach];
        let outside = each!(i of 3 => is_wide.select(outside[i], zero));
        Self { outside, ..Self::between(ends) }
    }

    /// What the tables say of the ends of a ray's.
    #[inline(always)]
    fn locate(&self, tables: &Tables, lane: usize) -> [Located<f32>; 2] {
        [self.ends[0].locate(tables, lane), self.ends[1].locate(tables, lane)]
    }

    /// The mean of (τ c, τ) of a ray's, given what the tables say of its ends.
    #[inline(always)]
    fn mean(&self, tables: &Tables, lane: usize, [low, high]: &[Located<f32>; 2]) -> [f32; 4] {
        let inside = optics_between_by(tables, low, high, self.per_width[lane]);
        let [below, above, width] = [self.outside[0][lane], self.outside[1][lane], self.outside[2][lane]];
        with_outside(inside, [low, high], (below, above), width)
    }
}

/// The means of (τ c, τ) of a segment of some rays.
#[inline(always)]
pub(super) fn mean<S: Simd>(tables: &Tables, segment: &Segment<S>, mut rays: u64) -> [f32x8<S>; 4] {
    let mut k = [[0.0; RAYS]; 4];
    while rays != 0 {
        let lane = first_of(&mut rays);
        put(&mut k, lane, segment.mean(tables, lane, &segment.locate(tables, lane)));
    }
    each!(c of 4 => load(segment.per_width.token(), &k[c], 0))
}

/// The means of four segments of some rays: of two that follow each other, of both, and of another. The first three `share` their ends,
/// or have their own.
#[inline(always)]
pub(super) fn means<S: Simd>(
    tables: &Tables,
    segments: &[Segment<S>; 4],
    share: bool,
    mut rays: u64,
) -> [[f32x8<S>; 4]; 4] {
    let mut k = [[[0.0; RAYS]; 4]; 4];
    while rays != 0 {
        let lane = first_of(&mut rays);
        let [first, second, both, other] = segments;
        let first = first.locate(tables, lane);
        let other = other.locate(tables, lane);
        let (second, both) = if share {
            let last = second.ends[1].locate(tables, lane);
            ([first[1], last], [first[0], last])
        } else {
            (second.locate(tables, lane), both.locate(tables, lane))
        };
        let ends = [first, second, both, other];
        for (segment, k) in k.iter_mut().enumerate() {
            put(k, lane, segments[segment].mean(tables, lane, &ends[segment]));
        }
    }
    let simd = segments[0].per_width.token();
    each!(segment of 4 => each!(c of 4 => load(simd, &k[segment][c], 0)))
}

#[inline(always)]
fn put(k: &mut [[f32; RAYS]; 4], lane: usize, mean: [f32; 4]) {
    for channel in 0..4 {
        k[channel][lane] = mean[channel];
    }
}
