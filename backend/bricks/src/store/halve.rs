//! From a level to the next coarser one: means over 2 × 2 × 2 voxels.
//!
//! A coarse voxel is the mean of all voxels of the source that it covers, so if the volume ends within it, its parts
//! are weighted by the voxels of the source that each holds. Squares add up by the law of total variance: the variance
//! within each of a coarse voxel's parts, plus that of their means about its own.

use super::level::{Level, Spread, SpreadRow, copy_row, covered};
use super::ring::{Ring, TILE};
use rayon::prelude::*;

/// Columns of the finer level under a tile.
const COLUMNS: usize = 2 * TILE;
/// Rows of the finer level under a row: two in each of two slabs.
const ROWS: usize = 4;

/// The fine rows under a coarse row, and how much each counts.
struct Under {
    /// Slab and row.
    rows: [(u32, usize); ROWS],
    /// Parts of one.
    weights: [f32; ROWS],
    /// Voxels of the source in a column of the coarse row: along y times along z.
    source_voxels: f64,
}

/// Numbers of the fine rows, those of one ring.
type Rows = [[f32; COLUMNS]; ROWS];

/// Writes slab `z / 2` of the coarser level from slab `z`, its last, and the one before. Returns the sum over all
/// voxels of the source in it of the squared difference between the finer level's means and the coarser's.
pub(super) fn halve(fine: &Level, z: u32, coarse: &mut Level, source: glam::UVec3) -> f64 {
    let width = coarse.dims.x as usize;
    let columns = Columns { count: width, edge: coarse.edge, source: source.x };
    let rows = coarse.spread_mut(z / 2).into_par_iter().enumerate();
    let squares = rows.map(|(tile_y, mut row)| {
        let under = |i: usize| under(fine, tile_y * TILE + i, z, [source.y, source.z]);
        let under: Vec<Under> = (0..row.means.rows).map(under).collect();
        let halve_tile = |tile: usize| {
            let uniform = fine_uniform(fine, tile, tile_y, z);
            row.uniform[tile] = uniform;
            match uniform.is_nan() {
                true => halve_tile(&mut row, fine, tile, &under, &columns),
                false => {
                    clear(&mut row, tile);
                    0.0
                }
            }
        };
        (0..width.div_ceil(TILE)).map(halve_tile).sum::<f64>()
    });
    // Summed in order: the sum must not depend on how threads share the rows.
    squares.collect::<Vec<f64>>().iter().sum()
}

fn clear(row: &mut SpreadRow, tile: usize) {
    let rings = [&mut row.means, &mut row.low, &mut row.high];
    rings.into_iter().chain(&mut row.deviation).for_each(|ring| ring.clear(tile));
}

/// The value of the up to eight fine tiles under a coarse tile; NaN if it is not the same.
fn fine_uniform(fine: &Level, tile_x: usize, tile_y: usize, z: u32) -> f32 {
    let [across, down] = fine.tiles();
    let value = fine.uniform(z, 2 * tile_x, 2 * tile_y);
    for slab in z & !1..=z {
        for y in 2 * tile_y..(2 * tile_y + 2).min(down) {
            for x in 2 * tile_x..(2 * tile_x + 2).min(across) {
                if fine.uniform(slab, x, y) != value {
                    return f32::NAN;
                }
            }
        }
    }
    value
}

fn under(fine: &Level, row: usize, z: u32, source: [u32; 2]) -> Under {
    let ys = [2 * row as u32, (2 * row as u32 + 1).min(fine.dims.y - 1)];
    let zs = [z & !1, z];
    let pair = |first: u32, source: u32| [0, 1].map(|i| f64::from(covered(first + i, fine.edge, source)));
    let (along_y, along_z) = (pair(2 * row as u32, source[0]), pair(z & !1, source[1]));
    let source_voxels = (along_y[0] + along_y[1]) * (along_z[0] + along_z[1]);
    let place = |i: usize| (i & 1, i >> 1);
    Under {
        rows: std::array::from_fn(|i| (zs[place(i).1], ys[place(i).0] as usize)),
        weights: std::array::from_fn(|i| (along_y[place(i).0] * along_z[place(i).1] / source_voxels) as f32),
        source_voxels,
    }
}

/// The columns of the coarse level.
struct Columns {
    count: usize,
    edge: u32,
    source: u32,
}

impl Columns {
    /// Voxels of the source that the two halves of a coarse column cover.
    fn halves(&self, column: usize) -> [f64; 2] {
        [0, 1].map(|half| f64::from(covered(2 * column as u32 + half, self.edge / 2, self.source)))
    }
}

/// A coarse row of one tile.
struct CoarseRow {
    means: [f32; TILE],
    low: [f32; TILE],
    high: [f32; TILE],
    /// Variance of the fine means about the coarse one, in squares of `unit`.
    between: [f32; TILE],
    /// A power of two near the row's range: squares of the largest and smallest f32 numbers do not fit f32.
    unit: f32,
}

/// Halves what is under a tile; returns the squares of [`halve`].
fn halve_tile(out: &mut SpreadRow, fine: &Level, tile: usize, under: &[Under], columns: &Columns) -> f64 {
    let count = TILE.min(columns.count - tile * TILE);
    let last = columns.halves(columns.count - 1);
    let of_last = last[0] + last[1];
    let is_cut = tile * TILE + count == columns.count && last[0] != last[1];
    let cut = is_cut.then(|| (count - 1, last.map(|half| (half / of_last) as f32)));
    let mut squares = 0.0;
    for (row, under) in under.iter().enumerate() {
        let coarse = coarse_row(fine, tile, under, cut);
        let at = row * count..(row + 1) * count;
        out.means.room(tile)[at.clone()].copy_from_slice(&coarse.means[..count]);
        out.low.room(tile)[at.clone()].copy_from_slice(&coarse.low[..count]);
        out.high.room(tile)[at.clone()].copy_from_slice(&coarse.high[..count]);
        if let Some(out) = &mut out.deviation {
            let within = within(fine, tile, under, cut, coarse.unit);
            for (i, out) in out.room(tile)[at].iter_mut().enumerate() {
                *out = (within[i] + coarse.between[i]).sqrt() * coarse.unit;
            }
        }
        let mut weighted = f64::from(coarse.between[..count].iter().sum::<f32>()) * f64::from(columns.edge);
        if is_cut {
            weighted += f64::from(coarse.between[count - 1]) * (of_last - f64::from(columns.edge));
        }
        squares += weighted * under.source_voxels * f64::from(coarse.unit).powi(2);
    }
    squares
}

/// The numbers of a ring under a tile's row; beyond the level's end its edge repeats, and counts nothing.
fn rows_of(fine: &Level, ring: &Ring, tile: usize, under: &Under, of_uniform: impl Fn(f32) -> f32) -> Rows {
    let mut rows = [[0.0; COLUMNS]; ROWS];
    let across = fine.tiles()[0];
    for (out, &(z, y)) in rows.iter_mut().zip(&under.rows) {
        let mut filled = 0;
        for (half, fine_tile) in (2 * tile..(2 * tile + 2).min(across)).enumerate() {
            let count = fine.tile_width(fine_tile);
            let start = y % TILE * count;
            let out = &mut out[half * TILE..half * TILE + count];
            let uniform = fine.uniform(z, fine_tile, y / TILE);
            match uniform.is_nan() {
                true => copy_row(&ring.tile(z, fine_tile, y / TILE)[start..start + count], out),
                false => out.fill(of_uniform(uniform)),
            }
            filled = half * TILE + count;
        }
        let edge = out[filled - 1];
        out[filled..].fill(edge);
    }
    rows
}

/// Weighted means of pairs of columns, after those of the rows; `cut` is the column whose halves count differently.
fn weighted_means(rows: &Rows, weights: [f32; ROWS], cut: Option<(usize, [f32; 2])>) -> [f32; TILE] {
    let column: [f32; COLUMNS] = std::array::from_fn(|i| {
        (rows[0][i] * weights[0] + rows[1][i] * weights[1])
            + (rows[2][i] * weights[2] + rows[3][i] * weights[3])
    });
    let mut means = std::array::from_fn(|i| 0.5 * column[2 * i] + 0.5 * column[2 * i + 1]);
    if let Some((at, [first, second])) = cut {
        means[at] = first * column[2 * at] + second * column[2 * at + 1];
    }
    means
}

/// Variance within the fine voxels, in squares of `unit`.
fn within(
    fine: &Level,
    tile: usize,
    under: &Under,
    cut: Option<(usize, [f32; 2])>,
    unit: f32,
) -> [f32; TILE] {
    match fine.spread.as_ref().and_then(|spread| spread.deviation.as_ref()) {
        Some(ring) => {
            let deviations = rows_of(fine, ring, tile, under, |_| 0.0);
            weighted_means(&squared(&deviations, &[0.0; TILE], unit), under.weights, cut)
        }
        None => [0.0; TILE],
    }
}

/// Squared differences to the coarse voxels around, in squares of `unit`.
fn squared(rows: &Rows, coarse: &[f32; TILE], unit: f32) -> Rows {
    let per_unit = 1.0 / unit;
    std::array::from_fn(|row| {
        std::array::from_fn(|i| {
            let difference = rows[row][i] * per_unit - coarse[i / 2] * per_unit;
            difference * difference
        })
    })
}

/// A power of two near the range of some numbers; within what f32 and its inverse have.
fn unit(low: &[f32; TILE], high: &[f32; TILE]) -> f32 {
    const LANES: usize = 4;
    let (mut lowest, mut highest) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
    for (low, high) in low.as_chunks::<LANES>().0.iter().zip(high.as_chunks::<LANES>().0) {
        for i in 0..LANES {
            lowest[i] = smaller(low[i], lowest[i]);
            highest[i] = larger(high[i], highest[i]);
        }
    }
    let lowest = lowest.into_iter().fold(f32::INFINITY, smaller);
    let range = f64::from(highest.into_iter().fold(f32::NEG_INFINITY, larger)) - f64::from(lowest);
    // The exponent of an f64, which is 0 for 0.
    let exponent = ((range.to_bits() >> 52) as i32 - 1023).clamp(-100, 120);
    f32::from_bits(((exponent + 127) as u32) << 23)
}

fn coarse_row(fine: &Level, tile: usize, under: &Under, cut: Option<(usize, [f32; 2])>) -> CoarseRow {
    let rows = rows_of(fine, &fine.means, tile, under, |value| value);
    let (low, high) = match &fine.spread {
        None => (picked(&rows, smaller), picked(&rows, larger)),
        Some(Spread { low, high, .. }) => (
            picked(&rows_of(fine, low, tile, under, |value| value), smaller),
            picked(&rows_of(fine, high, tile, under, |value| value), larger),
        ),
    };
    let raw = weighted_means(&rows, under.weights, cut);
    // Rounding must not carry a mean beyond the numbers it averages: equal voxels stay equal.
    let means: [f32; TILE] = std::array::from_fn(|i| raw[i].max(low[i]).min(high[i]));
    let unit = unit(&low, &high);
    let between = weighted_means(&squared(&rows, &means, unit), under.weights, cut);
    CoarseRow { means, low, high, between, unit }
}

fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

fn picked(rows: &Rows, pick: impl Fn(f32, f32) -> f32) -> [f32; TILE] {
    let column: [f32; COLUMNS] =
        std::array::from_fn(|i| pick(pick(rows[0][i], rows[1][i]), pick(rows[2][i], rows[3][i])));
    std::array::from_fn(|i| pick(column[2 * i], column[2 * i + 1]))
}
