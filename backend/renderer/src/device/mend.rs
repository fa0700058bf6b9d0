//! Pixels that cannot be resampled well from what planes have cast: each gets a ray of its own.

use super::job::{Patch, ViewJob};
use super::{CastJob, CastOutcome};
use crate::present::Bends;
use planes::{Fans, RasterWarp};
use rayon::prelude::*;
use twin::{Cast, Casting, SceneNumbers, cast_pixels};

/// The largest bend of colours from pixel to pixel that is left to resampling, in tolerances: a bend of b errs by about b/8 halfway,
/// and by more beside an edge. Chosen so that resampling adds little to what planes err.
const MOST_BEND: f32 = 160.0;

/// Mends pictures of the fans' views, as far as the job's `stop` allows.
pub(super) fn mend(casting: &Casting<f32>, job: &CastJob, fans: &Fans, pictures: &[Vec<f32>]) -> CastOutcome {
    let mut outcome = CastOutcome::nothing(job);
    for (index, view) in job.view_jobs() {
        let Some(warp) = fans.warp(index) else { continue };
        // Looking for bends goes through all of the picture.
        if (job.stop)() {
            outcome.left[index] = view.tiles.into_owned();
            continue;
        }
        let bends = bends_of(&pictures[index], warp, casting.scene);
        let cast = |tile: u32| (!(job.stop)()).then(|| mend_tile(casting, &view, &bends, tile));
        let tiles: Vec<u32> = view.tiles.iter().collect();
        let found: Vec<Option<(Patch, bool)>> = tiles.into_par_iter().map(cast).collect();
        for (tile, found) in view.tiles.iter().zip(found) {
            match found {
                None => outcome.left[index].push(tile),
                Some((patch, is_missing)) => {
                    outcome.rays += patch.len() as u64;
                    outcome.mended[index].extend(patch);
                    if job.counts && is_missing {
                        outcome.missing_tiles[index].push(tile);
                    }
                }
            }
        }
    }
    outcome
}

/// Where a picture that planes have cast bends too much to be resampled.
pub(super) fn bends_of<'a>(picture: &[f32], warp: &'a RasterWarp, scene: &SceneNumbers<f32>) -> Bends<'a> {
    Bends::of(picture, warp, MOST_BEND * scene.tolerance)
}

/// The pixels of a tile that take their light from there.
pub(super) fn pixels_near(view: &ViewJob, bends: &Bends, tile: u32) -> Vec<(u32, u32)> {
    view.pixels(tile).filter(|&(x, y)| bends.are_near(x, y)).collect()
}

/// The mended pixels of a tile, and whether one of their rays met a node that is too coarse.
fn mend_tile(casting: &Casting<f32>, view: &ViewJob, bends: &Bends, tile: u32) -> (Patch, bool) {
    let pixels = pixels_near(view, bends, tile);
    let casts: Vec<Cast<f32>> = cast_pixels(casting, view.rays, &pixels);
    let place = |(x, y): (u32, u32)| y * view.rays.raster[0] + x;
    let patch = pixels.iter().zip(&casts).map(|(&pixel, cast)| (place(pixel), cast.rgba)).collect();
    (patch, casts.iter().any(|cast| cast.is_missing))
}
