//! Rows of all views at once, on all cores of the CPU.

use super::{CastJob, CastOutcome, Sharing, TileList};
use layout::TILE_EDGE;
use optics::Enhancer;
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

/// Casts the rows that hold the tiles of a job, fan by fan.
pub(super) fn cast_rows(
    casting: &Casting<f32>,
    job: &CastJob,
    Sharing { fans, enhancers }: Sharing,
    pictures: &mut [Vec<f32>],
) -> CastOutcome {
    let mut outcome = CastOutcome::nothing(job);
    fans.iter().for_each(|fan| cast_fan(casting, job, (fan, enhancers), pictures, &mut outcome));
    outcome
}

fn cast_fan(
    casting: &Casting<f32>,
    job: &CastJob,
    (fan, enhancers): (&Fan, &[Enhancer]),
    pictures: &mut [Vec<f32>],
    outcome: &mut CastOutcome,
) {
    let [width, height] = fan.raster;
    let jobs: Vec<_> = job.view_jobs().filter(|(index, _)| fan.views.contains(index)).collect();
    let asked: BTreeSet<u32> = jobs.iter().flat_map(|(_, view)| view.rows_of_tiles()).collect();
    let planes = Planes::new(casting, fan, enhancers);
    let (step, first) = (job.lattice().step[1], job.lattice().first[1]);
    let of_fan = pictures.iter_mut().enumerate().filter(|(index, _)| fan.views.contains(index));
    let mut bands = bands(of_fan.map(|(_, picture)| picture), fan.raster, step);
    // The rows of a band that are cast, from its first.
    let cast_rows = |at: u32| {
        let rows = (height - at * TILE_EDGE * step).min(TILE_EDGE * step);
        (first..rows).step_by(step as usize)
    };
    let cast = |scratch: &mut Scratch, band: &mut Band| {
        let above = band.at * TILE_EDGE * step;
        (!(job.stop)()).then(|| {
            cast_rows(band.at).fold(RowCast::default(), |sum, row| {
                let (i, pixels) = (row as usize, 4 * width as usize);
                let mut out: Vec<&mut [f32]> =
                    band.pictures.iter_mut().map(|rows| &mut rows[i * pixels..(i + 1) * pixels]).collect();
                let found = planes.cast_row(above + row, scratch, &mut out);
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
    for (index, view) in &jobs {
        let rows_of = |of: &dyn Fn(&Option<RowCast>) -> bool| -> BTreeSet<u32> {
            found.iter().filter(|(_, cast)| of(cast)).map(|&(at, _)| at).collect()
        };
        let tiles_in = |rows: BTreeSet<u32>| -> TileList {
            view.tiles.iter().filter(|tile| rows.contains(&(tile / view.grid.across))).collect()
        };
        outcome.left[*index] = tiles_in(rows_of(&Option::is_none));
        if job.counts {
            outcome.missing_tiles[*index] =
                tiles_in(rows_of(&|cast| cast.is_some_and(|cast| cast.is_missing)));
        }
    }
    for (at, cast) in &found {
        if let Some(cast) = cast {
            outcome.rays += cast_rows(*at).count() as u64 * u64::from(width) * fan.views.len() as u64;
            outcome.samples += if job.counts { cast.samples } else { 0 };
        }
    }
}

/// The pictures, cut into rows of tiles that cast every `step`th row of pixels.
fn bands<'a>(
    pictures: impl Iterator<Item = &'a mut Vec<f32>>,
    [width, height]: [u32; 2],
    step: u32,
) -> Vec<Band<'a>> {
    let size = 4 * width as usize * height as usize;
    let rows = TILE_EDGE * step;
    let mut bands: Vec<Band> =
        (0..height.div_ceil(rows)).map(|at| Band { at, pictures: Vec::new() }).collect();
    for picture in pictures {
        picture.resize(size, 0.0);
        let rows = picture.chunks_mut(4 * width as usize * rows as usize);
        bands.iter_mut().zip(rows).for_each(|(band, rows)| band.pictures.push(rows));
    }
    bands
}
