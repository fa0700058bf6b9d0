//! The picture to show, made over the one that was shown before: rows that stand still are read, and not written.

use super::reconstruct::{Before, Filter, Pass, Raster, Thresholds, passes};
use super::{Classes, ease};
use rayon::prelude::*;
use std::ops::Range;

/// Rows that a thread makes one after the other: with what they were before, they fit a core's own cache.
const BAND: usize = 16;

/// How what is shown is made of what was cast. Pictures have four numbers a pixel, rows from the top.
#[derive(Clone, Copy)]
pub struct Show<'a> {
    /// What was cast.
    pub cast: &'a [f32],
    /// The size of the picture.
    pub raster: Raster,
    /// The pixels that stand; the others are reconstructed.
    pub known: Classes,
    /// How the others are reconstructed.
    pub thresholds: Thresholds,
    /// What any number of a pixel may change by, at most; None if it may by all.
    pub most_change: Option<f32>,
}

impl Show<'_> {
    /// Makes the picture over what was shown before, if that is of the same view: else it does not matter. Whether any pixel may
    /// not change by as much as it would.
    ///
    /// # Panics
    /// Where the cast picture has not as many numbers as the raster says.
    pub fn over(&self, shown: &mut Vec<f32>, has_before: bool) -> bool {
        let numbers = 4 * self.raster.width * self.raster.height;
        assert_eq!(self.cast.len(), numbers, "a picture fills its raster");
        // Another caster may have shown another raster.
        let has_before = has_before && shown.len() == numbers;
        shown.resize(numbers, 0.0);
        let filter = |picture, pass| {
            let &Self { raster, thresholds, .. } = self;
            Filter { picture, raster, pass, thresholds }
        };
        let mut passes = passes(self.known);
        match [passes.next(), passes.next()] {
            [Some(first), Some(last)] => {
                let mut partly = shown.clone();
                make_over(filter(self.cast, first), &mut partly, has_before, None);
                make_over(filter(&partly, last), shown, has_before, self.most_change)
            }
            [only, _] => {
                let only = only.unwrap_or(Pass { missing: Classes::default(), pairs: &[] });
                make_over(filter(self.cast, only), shown, has_before, self.most_change)
            }
        }
    }
}

/// The same as a picture of its own, of what was shown before, where anything was.
///
/// # Panics
/// Where the cast picture has not as many numbers as the raster says.
pub fn reconstruct(
    cast: &[f32],
    before: Option<&[f32]>,
    raster: Raster,
    known: Classes,
    thresholds: Thresholds,
) -> Vec<f32> {
    let mut shown = before.map(<[f32]>::to_vec).unwrap_or_default();
    Show { cast, raster, known, thresholds, most_change: None }.over(&mut shown, before.is_some());
    shown
}

/// Makes what is missing over what was shown before, if there is such a picture. Whether any pixel is behind.
fn make_over(filter: Filter, shown: &mut [f32], has_before: bool, most_change: Option<f32>) -> bool {
    let of_row = 4 * filter.raster.width;
    let of_band = BAND * of_row;
    if !has_before {
        let band = Band { filter, before: None, most_change: None };
        shown.par_chunks_mut(of_band).enumerate().for_each(|(at, rows)| {
            band.make(BAND * at, rows);
        });
        return false;
    }
    // What other threads may have made anew when a band looks at the rows beside it.
    let rims: Vec<[Vec<f32>; 2]> = shown
        .par_chunks(of_band)
        .map(|rows| [&rows[..of_row], &rows[rows.len() - of_row..]].map(<[f32]>::to_vec))
        .collect();
    let make = |was: &mut Vec<f32>, (at, rows): (usize, &mut [f32])| {
        let above = at.checked_sub(1).map(|at| &rims[at][1][..]).unwrap_or_default();
        let below = rims.get(at + 1).map(|[first, _]| &first[..]).unwrap_or_default();
        was.clear();
        [above, rows, below].iter().for_each(|rows| was.extend_from_slice(rows));
        let before = Before { numbers: was, first: at * of_band - above.len() };
        Band { filter, before: Some(before), most_change }.make(BAND * at, rows)
    };
    let bands = shown.par_chunks_mut(of_band).enumerate();
    bands.map_init(Vec::new, make).reduce(|| false, |a, b| a | b)
}

/// Some rows that are made.
struct Band<'a> {
    filter: Filter<'a>,
    /// What these were before, and one more on both sides; they are made over that.
    before: Option<Before<'a>>,
    most_change: Option<f32>,
}

/// Which pixels of some rows differ from what they were before, of those that are known.
struct Moved {
    rows: Range<usize>,
    width: usize,
    /// Row by row.
    flags: Vec<bool>,
}

impl Moved {
    fn row(&self, y: usize) -> &[bool] {
        &self.flags[(y - self.rows.start) * self.width..][..self.width]
    }
}

impl Band<'_> {
    /// Makes rows from the first on. Whether any pixel is behind.
    fn make(&self, first: usize, rows: &mut [f32]) -> bool {
        let Filter { picture, raster: Raster { width, height }, pass, .. } = self.filter;
        let of_row = 4 * width;
        let past = first + rows.len() / of_row;
        let around = first.saturating_sub(1)..(past + 1).min(height);
        let moved = self.before.map(|before| self.moved(before, around));
        let (mut moves, mut is_behind) = (vec![false; width], false);
        for (y, row) in (first..past).zip(rows.chunks_exact_mut(of_row)) {
            if let Some(moved) = &moved {
                self.moves_around(moved, y, &mut moves);
                if !moves.contains(&true) && !moved.row(y).contains(&true) {
                    continue;
                }
            }
            if !pass.missing.has_row(y) {
                row.copy_from_slice(&picture[y * of_row..][..of_row]);
            }
            for (x, pixel) in row.chunks_exact_mut(4).enumerate().filter(|&(x, _)| pass.missing.has(x, y)) {
                pixel.copy_from_slice(&self.filter.pixel(x, y, self.before, moves[x]));
            }
            if let (Some(before), Some(most)) = (self.before, self.most_change) {
                is_behind |= ease(&before.numbers[y * of_row - before.first..][..of_row], row, most);
            }
        }
        is_behind
    }

    /// Of these rows.
    fn moved(&self, before: Before, rows: Range<usize>) -> Moved {
        let Filter { picture, raster: Raster { width, .. }, pass, .. } = self.filter;
        let of_row = 4 * width;
        let mut flags = vec![false; rows.len() * width];
        for (y, flags) in rows.clone().zip(flags.chunks_exact_mut(width)) {
            if pass.missing.has_row(y) {
                continue;
            }
            let now = picture[y * of_row..][..of_row].chunks_exact(4);
            let was = before.numbers[y * of_row - before.first..][..of_row].chunks_exact(4);
            for ((flag, now), was) in flags.iter_mut().zip(now).zip(was) {
                // All four at once, which is faster than to leave off early.
                *flag = (0..4).fold(0, |bits, c| bits | (now[c].to_bits() ^ was[c].to_bits())) != 0;
            }
        }
        Moved { rows, width, flags }
    }

    /// Whether any neighbour of each missing pixel of a row has moved.
    fn moves_around(&self, moved: &Moved, y: usize, moves: &mut [bool]) {
        moves.fill(false);
        let pass = self.filter.pass;
        if !(pass.missing.has(0, y) || pass.missing.has(1, y)) {
            return;
        }
        for [dx, dy] in pass.pairs.iter().flat_map(|&[dx, dy]| [[dx, dy], [-dx, -dy]]) {
            let Some(row) = y.checked_add_signed(dy as isize).filter(|row| moved.rows.contains(row)) else {
                continue;
            };
            let [into, from] = [-dx, dx].map(|ahead| ahead.max(0) as usize);
            let (moves, moved) = (&mut moves[into..], &moved.row(row)[from..]);
            moves.iter_mut().zip(moved).for_each(|(moves, moved)| *moves |= moved);
        }
    }
}

#[cfg(test)]
#[path = "show_tests.rs"]
mod tests;
