//! Taking slabs of the source over into the finest level.

use super::level::{Level, TILE};
use super::quantise::range;
use super::tally::ErrorTally;
use crate::volume::{Sample, Samples, VolumeInfo, with_samples};
use rayon::prelude::*;

/// What passed from the source into the finest level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken {
    pub smallest: f64,
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

/// Takes a slab of finite values over.
pub(super) fn take(level: &mut Level, z: u32, slab: &Samples, info: &VolumeInfo) -> Taken {
    with_samples!(slab, |stored| take_stored(level, z, stored, info))
}

fn take_stored<S: Sample>(level: &mut Level, z: u32, stored: &[S], info: &VolumeInfo) -> Taken {
    let (width, tiles) = (level.dims.x as usize, level.tiles()[0]);
    let is_plain = S::IS_EXACT_IN_F32 && info.is_unscaled();
    let (means, uniform) = level.slab_mut(z);
    let rows = stored.par_chunks(TILE * width).zip(means.par_chunks_mut(TILE * width));
    rows.zip(uniform.par_chunks_mut(tiles))
        .map(|((stored, means), uniform)| match is_plain {
            true => take_exact(stored, width, means, uniform),
            false => take_rounded(stored, width, info, means, uniform),
        })
        .reduce(Taken::nothing, Taken::merge)
}

/// A row of tiles whose numbers are the data values, and exact in f32.
fn take_exact<S: Sample>(stored: &[S], width: usize, means: &mut [f32], uniform: &mut [f32]) -> Taken {
    let mut bounds = (f32::INFINITY, f32::NEG_INFINITY);
    for (tile, uniform) in uniform.iter_mut().enumerate() {
        let columns = tile * TILE..((tile + 1) * TILE).min(width);
        let first = stored[columns.start].to_f32();
        let is_uniform = stored
            .chunks_exact(width)
            .all(|row| row[columns.clone()].iter().fold(true, |all, v| all & (v.to_f32() == first)));
        *uniform = if is_uniform { first } else { f32::NAN };
        let bounds_of_tile = match is_uniform {
            true => (first, first),
            false => convert(stored, width, columns, means),
        };
        bounds = (bounds.0.min(bounds_of_tile.0), bounds.1.max(bounds_of_tile.1));
    }
    Taken { smallest: bounds.0.into(), largest: bounds.1.into(), ..Taken::nothing() }
}

/// Converts some columns; returns their smallest and largest value.
fn convert<S: Sample>(
    stored: &[S],
    width: usize,
    columns: std::ops::Range<usize>,
    means: &mut [f32],
) -> (f32, f32) {
    let mut bounds = (f32::INFINITY, f32::NEG_INFINITY);
    for (row, means) in stored.chunks_exact(width).zip(means.chunks_exact_mut(width)) {
        let means = &mut means[columns.clone()];
        for (mean, value) in means.iter_mut().zip(&row[columns.clone()]) {
            *mean = value.to_f32();
        }
        let (low, high) = range(means);
        bounds = (bounds.0.min(low), bounds.1.max(high));
    }
    bounds
}

/// A row of tiles of any numbers, scaled perhaps.
fn take_rounded<S: Sample>(
    stored: &[S],
    width: usize,
    info: &VolumeInfo,
    means: &mut [f32],
    uniform: &mut [f32],
) -> Taken {
    let mut taken = Taken::nothing();
    for (&stored, mean) in stored.iter().zip(means.iter_mut()) {
        let value = info.value(stored.to_f64());
        *mean = value as f32;
        taken.smallest = taken.smallest.min(value);
        taken.largest = taken.largest.max(value);
        let error = value - f64::from(*mean);
        taken.rounding.merge(ErrorTally { max: error.abs(), squares: error * error });
    }
    for (tile, uniform) in uniform.iter_mut().enumerate() {
        let columns = tile * TILE..((tile + 1) * TILE).min(width);
        let first = means[columns.start];
        let is_uniform =
            means.chunks_exact(width).all(|row| row[columns.clone()].iter().all(|&v| v == first));
        *uniform = if is_uniform { first } else { f32::NAN };
    }
    taken
}
