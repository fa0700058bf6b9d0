//! The transfer functions at equal distances, looked up for eight scalars at once.

use crate::slab::LANES;
use lanes::*;
use needs::tables::{TABLE_CELLS, Tables};
use twin::tables::{locate, optics_between};

/// Entries of each of the tables' cells.
const PER_CELL: usize = 2;
/// Entries, less one.
const CELLS: usize = PER_CELL * TABLE_CELLS;
/// Closer scalars than this have the mean of their values, as a difference of integrals would have no digits.
pub(crate) const CLOSE: f32 = 1.0 / 2048.0;

/// Means over fewer scalars than this to both sides are taken over as many.
const LEAST_SPREAD: f32 = 2.0 / CELLS as f32;

/// f = (τ c, τ) and F = ∫ f at equal distances.
#[derive(Clone, Debug)]
pub(crate) struct FineTable {
    entries: Vec<[f32; LANES]>,
    /// f alone, and F.
    values: Vec<[f32; 4]>,
    integrals: Vec<[f32; 4]>,
    /// The largest error of a mean that rounding makes, in units of the table.
    pub(crate) rounding: f32,
}

/// What eight scalars look up: f and F, each (τ c, τ).
#[derive(Clone, Copy)]
pub(crate) struct Looked<S: Simd> {
    pub(crate) value: [f32x8<S>; 4],
    integral: [f32x8<S>; 4],
}

impl FineTable {
    pub(crate) fn of(tables: &Tables) -> Self {
        let places: Vec<_> = (0..=CELLS).map(|i| locate(tables, i as f32 / CELLS as f32)).collect();
        let mut sums = [0.0f64; 4];
        let mut entries = Vec::with_capacity(CELLS + 1);
        for (i, place) in places.iter().enumerate() {
            let value = place.value();
            entries.push(std::array::from_fn(|c| if c < 4 { value[c] } else { sums[c - 4] as f32 }));
            if let Some(next) = places.get(i + 1) {
                let mean: [f32; 4] = optics_between(tables, place, next);
                for (sum, mean) in sums.iter_mut().zip(mean) {
                    *sum += f64::from(mean) / CELLS as f64;
                }
            }
        }
        let most = sums.into_iter().fold(0.0, f64::max);
        let values = entries.iter().map(|e: &[f32; LANES]| [e[0], e[1], e[2], e[3]]).collect();
        let integrals = entries.iter().map(|e| [e[4], e[5], e[6], e[7]]).collect();
        Self {
            entries,
            values,
            integrals,
            rounding: (2.0 * most * f64::from(f32::EPSILON) / f64::from(CLOSE)) as f32,
        }
    }

    /// At scalars in [0, 1].
    #[inline(always)]
    pub(crate) fn look_up<S: Simd>(&self, simd: S, scalars: f32x8<S>) -> Looked<S> {
        let (whole, part) = place_of(simd, scalars);
        // F is a parabola between two entries.
        let bend = part * (splat(simd, 1.0) - part) * splat(simd, -0.5 / CELLS as f32);
        let (part, bend) = (part.to_array(), bend.to_array());
        let mut values = [0.0f32; 4 * LANES];
        let mut integrals = [0.0f32; 4 * LANES];
        for lane in 0..LANES {
            let entry = whole[lane];
            let [low, high] = [&self.entries[entry], &self.entries[entry + 1]];
            let (f0, f1) = (f32x4::from_slice(simd, &low[..4]), f32x4::from_slice(simd, &high[..4]));
            let (i0, i1) = (f32x4::from_slice(simd, &low[4..]), f32x4::from_slice(simd, &high[4..]));
            let (t, b) = (f32x4::splat(simd, part[lane]), f32x4::splat(simd, bend[lane]));
            let rise = f1 - f0;
            (f0 + rise * t).store_slice(&mut values[4 * lane..4 * lane + 4]);
            (i0 + (i1 - i0) * t + rise * b).store_slice(&mut integrals[4 * lane..4 * lane + 4]);
        }
        Looked { value: columns(simd, &values), integral: columns(simd, &integrals) }
    }

    /// f alone, at scalars in [0, 1].
    #[inline(always)]
    pub(crate) fn value_at<S: Simd>(&self, simd: S, scalars: f32x8<S>) -> [f32x8<S>; 4] {
        straight_between(simd, &self.values, scalars)
    }

    /// Mean of (τ c, τ) over segments between two scalars, each of which stands for those within `spread` of it; see
    /// `twin::spread`.
    #[inline(always)]
    pub(crate) fn mean_around<S: Simd>(
        &self,
        simd: S,
        [from, to]: [f32x8<S>; 2],
        spread: f32x8<S>,
    ) -> [f32x8<S>; 4] {
        let (zero, one, half) = (splat(simd, 0.0), splat(simd, 1.0), splat(simd, 0.5));
        // A narrower one tells no more, and the difference of integrals no digits.
        let spread = spread.max(splat(simd, LEAST_SPREAD));
        let along = half * (to - from);
        let reach = (along * along + spread * spread).sqrt();
        let middle = half * (from + to);
        let (lowest, highest) = (middle - reach, middle + reach);
        let (low, high) = (lowest.max(zero), highest.min(one));
        let (at_low, at_high) = (self.integral_at(simd, low), self.integral_at(simd, high));
        let per = one / (high - low);
        let inside = each!(c of 4 => ((at_high[c] - at_low[c]) * per).max(zero));
        let (below, above) = ((zero - lowest).max(zero), (highest - one).max(zero));
        if !(below + above).simd_gt(zero).any_true() {
            return inside;
        }
        let width = reach + reach;
        let per = one / width.simd_gt(zero).select(width, one);
        let within = (width - below - above) * per;
        let (below, above) = (below * per, above * per);
        let [lowest, highest] = [&self.entries[0], &self.entries[CELLS]];
        each!(c of 4 => inside[c] * within + splat(simd, lowest[c]) * below + splat(simd, highest[c]) * above)
    }

    /// F alone, at scalars that are apart: straight between entries.
    #[inline(always)]
    fn integral_at<S: Simd>(&self, simd: S, scalars: f32x8<S>) -> [f32x8<S>; 4] {
        straight_between(simd, &self.integrals, scalars)
    }
}

/// A list's numbers at eight scalars, straight between entries.
#[inline(always)]
fn straight_between<S: Simd>(simd: S, list: &[[f32; 4]], scalars: f32x8<S>) -> [f32x8<S>; 4] {
    let (whole, part) = place_of(simd, scalars);
    let part = part.to_array();
    let mut found = [0.0f32; 4 * LANES];
    for lane in 0..LANES {
        let entry = whole[lane];
        let (low, high) = (f32x4::from_slice(simd, &list[entry]), f32x4::from_slice(simd, &list[entry + 1]));
        let at = low + (high - low) * f32x4::splat(simd, part[lane]);
        at.store_slice(&mut found[4 * lane..4 * lane + 4]);
    }
    columns(simd, &found)
}

/// The entries at or below eight scalars, none of them the last, and how far they are from there to the next.
#[inline(always)]
fn place_of<S: Simd>(simd: S, scalars: f32x8<S>) -> ([usize; LANES], f32x8<S>) {
    let u = scalars * splat(simd, CELLS as f32);
    let u = u.min(splat(simd, CELLS as f32)).max(splat(simd, 0.0));
    let low = u.floor().min(splat(simd, CELLS as f32 - 1.0));
    let whole: i32x8<S> = low.to_int();
    let whole = whole.to_array();
    let mut entries = [0; LANES];
    for lane in 0..LANES {
        entries[lane] = (whole[lane] as usize).min(CELLS - 1);
    }
    (entries, u - low)
}

/// Eight rows of four, as four columns of eight.
#[inline(always)]
fn columns<S: Simd>(simd: S, rows: &[f32; 4 * LANES]) -> [f32x8<S>; 4] {
    let low = f32x4::load_four_interleaved(simd, &rows[..2 * LANES]);
    let high = f32x4::load_four_interleaved(simd, &rows[2 * LANES..]);
    [low[0].combine(high[0]), low[1].combine(high[1]), low[2].combine(high[2]), low[3].combine(high[3])]
}

/// Mean of (τ c, τ) between scalars `apart` from each other.
#[inline(always)]
pub(crate) fn mean_between<S: Simd>(simd: S, a: &Looked<S>, b: &Looked<S>, apart: f32x8<S>) -> [f32x8<S>; 4] {
    let half = splat(simd, 0.5);
    let is_close = apart.abs().simd_lt(splat(simd, CLOSE));
    if is_close.all_true() {
        return each!(c of 4 => half * (a.value[c] + b.value[c]));
    }
    let per = splat(simd, 1.0) / is_close.select(splat(simd, 1.0), apart);
    each!(c of 4 => {
        let quotient = ((b.integral[c] - a.integral[c]) * per).max(splat(simd, 0.0));
        is_close.select(half * (a.value[c] + b.value[c]), quotient)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use lanes::{Level, dispatch};
    use needs::Needs;
    use optics::{Curve, Optics};
    use twin::tables::Located;

    /// At both ends of the domain nothing is lost of what the tables have there: short of the last entry, a narrow mean was dark.
    #[test]
    fn means_at_both_ends_are_those_of_the_tables() {
        let extinction = Curve::new(vec![(0.0, 0.4), (0.2, 0.0), (0.8, 0.0), (1.0, 0.3)]).unwrap();
        let tables = Tables::new(&Optics::grey(extinction), &Needs::PLAIN);
        let fine = FineTable::of(&tables);
        let truth = |from: f32, to: f32| -> f32 {
            let [a, b]: [Located<f32>; 2] = [from, to].map(|s| locate(&tables, s));
            optics_between(&tables, &a, &b)[3]
        };
        for (from, to) in
            [(1.0, 1.0), (0.999, 1.0), (0.9994, 1.0), (1.0, 0.95), (0.0, 0.0), (0.0006, 0.0), (0.0, 0.1)]
        {
            let level = Level::new();
            let expected = truth(from, to);
            let found = dispatch!(level, simd => {
                let ends = [splat(simd, from), splat(simd, to)];
                let [a, b] = [fine.look_up(simd, ends[0]), fine.look_up(simd, ends[1])];
                let [a, b] = if from < to { [a, b] } else { [b, a] };
                let apart = (ends[1] - ends[0]).abs();
                [mean_between(simd, &a, &b, apart)[3].to_array()[0], fine.mean_around(simd, ends, splat(simd, 0.0))[3].to_array()[0]]
            });
            let [between, around] = found.map(|found| (found - expected).abs() / expected);
            assert!(between < 2e-3, "{from} to {to}: {found:?}, not {expected}");
            // Over as many scalars at least as two entries have, some of them beyond the end.
            assert!(around < 6e-3, "{from} to {to}: {found:?}, not {expected}");
        }
    }
}
