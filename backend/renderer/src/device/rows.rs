//! Rows of all views at once, on all cores of the CPU.

use super::{CastJob, CastOutcome};
use layout::TILE_EDGE;
use planes::{Fan, Planes, RowCast, Scratch};
use rayon::prelude::*;
use std::collections::BTreeSet;
use twin::Casting;

/// A row of tiles: the rows of pixels that it stands for, of each view.
struct Band<'a> {
    /// Its place from the top.
    at: u32,
    pictures: Vec<&'a mut [f32]>,
}

/// Casts the rows that hold the tiles of a job.
pub(super) fn cast_rows(
    casting: &Casting<f32>,
    job: &CastJob,
    fan: &Fan,
    pictures: &mut [Vec<f32>],
) -> CastOutcome {
    let [width, height] = fan.raster;
    let jobs: Vec<_> = job.view_jobs().collect();
    let tiles = jobs.iter().flat_map(|(_, view)| view.tiles.iter().map(|tile| tile / view.grid.across));
    let asked: BTreeSet<u32> = tiles.collect();
    let planes = Planes::new(casting, fan);
    let mut bands = bands(pictures, fan.raster);
    let cast = |scratch: &mut Scratch, band: &mut Band| {
        let rows = band.at * TILE_EDGE..((band.at + 1) * TILE_EDGE).min(height);
        (!(job.stop)()).then(|| {
            rows.enumerate().fold(RowCast::default(), |sum, (i, row)| {
                let pixels = 4 * width as usize;
                let mut out: Vec<&mut [f32]> =
                    band.pictures.iter_mut().map(|rows| &mut rows[i * pixels..(i + 1) * pixels]).collect();
                let found = planes.cast_row(row, scratch, &mut out);
                RowCast {
                    samples: sum.samples + found.samples,
                    is_missing: sum.is_missing || found.is_missing,
                }
            })
        })
    };
    let found: Vec<(u32, Option<RowCast>)> = bands
        .par_iter_mut()
        .filter(|band| asked.contains(&band.at))
        .map_init(Scratch::default, |scratch, band| (band.at, cast(scratch, band)))
        .collect();
    let mut outcome = CastOutcome::nothing(job);
    for (index, view) in &jobs {
        let rows_of = |of: &dyn Fn(&Option<RowCast>) -> bool| -> BTreeSet<u32> {
            found.iter().filter(|(_, cast)| of(cast)).map(|&(at, _)| at).collect()
        };
        let tiles_in = |rows: BTreeSet<u32>| -> Vec<u32> {
            view.tiles.iter().copied().filter(|tile| rows.contains(&(tile / view.grid.across))).collect()
        };
        outcome.left[*index] = tiles_in(rows_of(&Option::is_none));
        if job.has_counts() {
            outcome.missing_tiles[*index] =
                tiles_in(rows_of(&|cast| cast.is_some_and(|cast| cast.is_missing)));
        }
    }
    for (at, cast) in &found {
        if let Some(cast) = cast {
            let rows = ((at + 1) * TILE_EDGE).min(height) - at * TILE_EDGE;
            outcome.rays += u64::from(rows) * u64::from(width) * job.views.len() as u64;
            outcome.samples += if job.has_counts() { cast.samples } else { 0 };
        }
    }
    outcome
}

/// The pictures, cut into rows of tiles.
fn bands(pictures: &mut [Vec<f32>], [width, height]: [u32; 2]) -> Vec<Band<'_>> {
    let size = 4 * width as usize * height as usize;
    let mut bands: Vec<Band> =
        (0..height.div_ceil(TILE_EDGE)).map(|at| Band { at, pictures: Vec::new() }).collect();
    for picture in pictures {
        picture.resize(size, 0.0);
        let rows = picture.chunks_mut(4 * width as usize * TILE_EDGE as usize);
        bands.iter_mut().zip(rows).for_each(|(band, rows)| band.pictures.push(rows));
    }
    bands
}
