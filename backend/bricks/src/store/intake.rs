//! Copying slabs of the source into the finest level.

use super::level::Level;
use super::ring::{TILE, TileRow};
use super::tally::ErrorTally;
use crate::volume::{Sample, Samples, VolumeInfo, with_samples};
use rayon::prelude::*;

/// What passed from the source into the finest level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken {
    /// Of values that are not exact in f32; infinite where all are.
    pub smallest: f64,
    /// Likewise.
    pub largest: f64,
    /// Error of keeping the source's values as f32: none for integers up to 24 bits and for f32.
    pub rounding: ErrorTally,
}

impl Taken {
    pub fn nothing() -> Self {
        Self { smallest: f64::INFINITY, largest: f64::NEG_INFINITY, rounding: ErrorTally::default() }
    }

    pub fn merge(mut self, other: Self) -> Self {
        self.smallest = self.smallest.min(other.smallest);
        self.largest = self.largest.max(other.largest);
        self.rounding.merge(other.rounding);
        self
    }
}

/// Copies a slab of finite values.
pub(super) fn take(level: &mut Level, z: u32, slab: &Samples, info: &VolumeInfo) -> Taken {
    with_samples!(slab, |stored| take_stored(level, z, stored, info))
}

fn take_stored<S: Sample>(level: &mut Level, z: u32, stored: &[S], info: &VolumeInfo) -> Taken {
    let width = level.dims.x as usize;
    let is_plain = S::IS_EXACT_IN_F32 && info.is_unscaled();
    let rows = stored.par_chunks(TILE * width).zip(level.slab_mut(z));
    let taken = rows.map(|(stored, (means, uniform))| match is_plain {
        true => take_exact(stored, width, means, uniform),
        false => take_rounded(stored, width, info, means, uniform),
    });
    // Summed in order: the sum must not depend on how threads share the rows.
    taken.collect::<Vec<_>>().into_iter().fold(Taken::nothing(), Taken::merge)
}

/// A row of tiles whose numbers are the data values, and exact in f32: their range is that of the bricks to be.
fn take_exact<S: Sample>(stored: &[S], width: usize, mut means: TileRow, uniform: &mut [f32]) -> Taken {
    for (tile, uniform) in uniform.iter_mut().enumerate() {
        let columns = tile * TILE..((tile + 1) * TILE).min(width);
        let first = stored[columns.start].to_f32();
        let is_uniform = stored
            .chunks_exact(width)
            .all(|row| row[columns.clone()].iter().fold(true, |all, v| all & (v.to_f32() == first)));
        *uniform = if is_uniform { first } else { f32::NAN };
        if is_uniform {
            means.clear(tile);
            continue;
        }
        for_rows(stored, width, tile, means.room(tile), |row, means| {
            means.iter_mut().zip(row).for_each(|(mean, value)| *mean = value.to_f32());
        });
    }
    Taken::nothing()
}

/// Calls a function with every row of a tile: the stored numbers, and the space for them.
fn for_rows<S>(
    stored: &[S],
    width: usize,
    tile: usize,
    room: &mut [f32],
    mut act: impl FnMut(&[S], &mut [f32]),
) {
    let columns = tile * TILE..((tile + 1) * TILE).min(width);
    for (row, means) in stored.chunks_exact(width).zip(room.chunks_exact_mut(columns.len())) {
        act(&row[columns.clone()], means);
    }
}

/// A row of tiles of any numbers, scaled perhaps.
fn take_rounded<S: Sample>(
    stored: &[S],
    width: usize,
    info: &VolumeInfo,
    mut means: TileRow,
    uniform: &mut [f32],
) -> Taken {
    let mut taken = Taken::nothing();
    for (tile, uniform) in uniform.iter_mut().enumerate() {
        let (mut first, mut is_uniform) = (None, true);
        for_rows(stored, width, tile, means.room(tile), |row, means| {
            for (&stored, mean) in row.iter().zip(means) {
                let value = info.value(stored.to_f64());
                *mean = value as f32;
                taken.smallest = taken.smallest.min(value);
                taken.largest = taken.largest.max(value);
                let error = value - f64::from(*mean);
                taken.rounding.merge(ErrorTally { max: error.abs(), squares: error * error });
                is_uniform &= *first.get_or_insert(*mean) == *mean;
            }
        });
        *uniform = first.filter(|_| is_uniform).unwrap_or(f32::NAN);
        if is_uniform {
            means.clear(tile);
        }
    }
    taken
}
