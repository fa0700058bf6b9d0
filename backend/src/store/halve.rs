//! From a level to the next coarser one: means over 2 × 2 × 2 voxels.
//!
//! A coarse voxel is the mean of all voxels of the source that it covers, so where the volume ends within it, its
//! parts count by the voxels of the source that each holds. Squares add up by the law of total variance: what a
//! coarse voxel's parts vary within themselves, and what their means vary about its own.

use super::level::{Level, Spread, SpreadSlab, TILE};
use super::ring::Ring;
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
    let (width, [tiles, tile_rows]) = (coarse.dims.x as usize, coarse.tiles());
    let under = |row: usize| under(fine, row, z, [source.y, source.z]);
    let columns = Columns { count: width, edge: coarse.edge, source: source.x };
    let room = TILE * width;
    let SpreadSlab { means, uniform, low, high, variance } = coarse.spread_mut(z / 2);
    let variances: Vec<&mut [f32]> = match variance {
        Some(variance) => variance.chunks_mut(room).collect(),
        None => (0..tile_rows).map(|_| &mut [][..]).collect(),
    };
    let rooms = means.par_chunks_mut(room).zip(low.par_chunks_mut(room)).zip(high.par_chunks_mut(room));
    let rooms = rooms.zip(variances).zip(uniform.par_chunks_mut(tiles));
    rooms
        .enumerate()
        .map(|(tile_y, ((((means, low), high), variance), uniform))| {
            let rows = (means.len() / width).min(TILE);
            let under: Vec<Under> = (0..rows).map(|row| under(tile_y * TILE + row)).collect();
            let mut out = TileRow { means, low, high, variance, width };
            let mut squares = 0.0;
            for (tile, uniform) in uniform.iter_mut().enumerate() {
                *uniform = fine_uniform(fine, tile, tile_y, z);
                if uniform.is_nan() {
                    squares += out.halve_tile(fine, tile, &under, &columns);
                }
            }
            squares
        })
        .sum()
}

/// The value of the up to eight fine tiles under a coarse tile; NaN where it is not the same.
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
    // Voxels of the source that a fine voxel covers along an axis; none for a voxel that does not exist.
    let covered = |i: u32, fine_voxels: u32, source: u32| {
        let start = u64::from(i) * u64::from(fine.edge);
        let end = (start + u64::from(fine.edge)).min(u64::from(source));
        if i < fine_voxels { end.saturating_sub(start) as f64 } else { 0.0 }
    };
    let along_y = [0, 1].map(|i| covered(2 * row as u32 + i, fine.dims.y, source[0]));
    let along_z = [0, 1].map(|i| covered((z & !1) + i, fine.dims.z, source[1]));
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
        let start = column as u64 * u64::from(self.edge);
        let middle = (start + u64::from(self.edge / 2)).min(u64::from(self.source));
        let end = (start + u64::from(self.edge)).min(u64::from(self.source));
        [(middle - start) as f64, (end - middle) as f64]
    }
}

/// The room of a row of tiles in a coarse slab.
struct TileRow<'a> {
    means: &'a mut [f32],
    low: &'a mut [f32],
    high: &'a mut [f32],
    /// Empty where it is not kept.
    variance: &'a mut [f32],
    width: usize,
}

/// A coarse row of one tile.
struct CoarseRow {
    means: [f32; TILE],
    low: [f32; TILE],
    high: [f32; TILE],
    /// Of the fine means about the coarse one.
    between: [f32; TILE],
}

impl TileRow<'_> {
    fn halve_tile(&mut self, fine: &Level, tile: usize, under: &[Under], columns: &Columns) -> f64 {
        let start = tile * TILE;
        let count = TILE.min(self.width - start);
        let last = columns.halves(columns.count - 1);
        let is_cut = start + count == columns.count && last[0] != last[1];
        let cut = is_cut.then(|| (count - 1, [last[0] / (last[0] + last[1]), last[1] / (last[0] + last[1])]));
        let mut squares = 0.0;
        for (row, under) in under.iter().enumerate() {
            let coarse = coarse_row(fine, tile, under, cut.map(|(at, parts)| (at, parts.map(|w| w as f32))));
            let at = row * self.width + start;
            self.means[at..at + count].copy_from_slice(&coarse.means[..count]);
            self.low[at..at + count].copy_from_slice(&coarse.low[..count]);
            self.high[at..at + count].copy_from_slice(&coarse.high[..count]);
            if !self.variance.is_empty() {
                let variance =
                    variance(fine, tile, under, cut.map(|(at, parts)| (at, parts.map(|w| w as f32))));
                for (i, out) in self.variance[at..at + count].iter_mut().enumerate() {
                    *out = variance[i] + coarse.between[i];
                }
            }
            let whole = coarse.between[..count].iter().sum::<f32>();
            let mut weighted = f64::from(whole) * f64::from(columns.edge);
            if is_cut {
                weighted +=
                    f64::from(coarse.between[count - 1]) * (last[0] + last[1] - f64::from(columns.edge));
            }
            squares += weighted * under.source_voxels;
        }
        squares
    }
}

/// The numbers of a ring under a tile's row; beyond the level's end its edge repeats, and counts nothing.
fn rows_of(fine: &Level, ring: &Ring, tile: usize, under: &Under, of_uniform: impl Fn(f32) -> f32) -> Rows {
    let mut rows = [[0.0; COLUMNS]; ROWS];
    let across = fine.tiles()[0];
    for (out, &(z, y)) in rows.iter_mut().zip(&under.rows) {
        let row = ring.row(z, y);
        let mut filled = 0;
        for (half, fine_tile) in (2 * tile..(2 * tile + 2).min(across)).enumerate() {
            let count = fine.tile_width(fine_tile);
            let out = &mut out[half * TILE..half * TILE + count];
            let uniform = fine.uniform(z, fine_tile, y / TILE);
            match uniform.is_nan() {
                true => out.copy_from_slice(&row[fine_tile * TILE..fine_tile * TILE + count]),
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

fn variance(fine: &Level, tile: usize, under: &Under, cut: Option<(usize, [f32; 2])>) -> [f32; TILE] {
    match fine.spread.as_ref().and_then(|spread| spread.variance.as_ref()) {
        Some(ring) => weighted_means(&rows_of(fine, ring, tile, under, |_| 0.0), under.weights, cut),
        None => [0.0; TILE],
    }
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
    // Rounding must not carry a mean out of what it is a mean of: equal voxels stay equal.
    let means: [f32; TILE] = std::array::from_fn(|i| larger(low[i], smaller(high[i], raw[i])));
    let squared: Rows = std::array::from_fn(|row| {
        std::array::from_fn(|i| {
            let difference = rows[row][i] - means[i / 2];
            difference * difference
        })
    });
    CoarseRow { means, low, high, between: weighted_means(&squared, under.weights, cut) }
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
