//! The tiles of one view, ray by ray, on all cores of the CPU.

use super::job::ViewJob;
use layout::TILE_EDGE;
use protocol::StopAsked;
use rayon::prelude::*;
use twin::{Cast, Casting, cast_pixels};

/// What the rays of a tile found, their colours apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileFound {
    pub(super) rays: u64,
    pub(super) samples: u64,
    /// Whether one of them met a node that is too coarse.
    pub(super) is_missing: bool,
}

/// Casts the tiles of a view into its picture, as far as `stop` allows: what each found, in the order of the tiles; None for
/// those that were left.
pub(super) fn cast_tiles(
    casting: &Casting<f32>,
    view: &ViewJob,
    stop: StopAsked,
    picture: &mut Vec<f32>,
) -> Vec<Option<TileFound>> {
    let [width, height] = view.rays.raster.map(|n| n as usize);
    picture.resize(4 * width * height, 0.0);
    // Tiles beside each other share rows of the picture: each row of tiles is put down by whoever has it.
    let mut bands = vec![Vec::new(); view.grid.down as usize];
    for (place, &tile) in view.tiles.iter().enumerate() {
        bands[(tile / view.grid.across) as usize].push((place, tile));
    }
    let rows = (TILE_EDGE * view.grid.lattice.step[1]) as usize;
    let cast_band = |((at, tiles), rgba): ((usize, Vec<(usize, u32)>), &mut [f32])| {
        let cast = |&(place, tile): &(usize, u32)| (place, (!stop()).then(|| cast_tile(casting, view, tile)));
        let casts: Vec<(usize, Option<TileCasts>)> = tiles.par_iter().map(cast).collect();
        let note = |(place, casts): (usize, Option<TileCasts>)| {
            (place, casts.map(|casts| put_down(&casts, &mut *rgba, width, at * rows)))
        };
        casts.into_iter().map(note).collect::<Vec<_>>()
    };
    let bands = bands.into_par_iter().enumerate().zip(picture.par_chunks_mut(4 * width * rows));
    let mut found = vec![None; view.tiles.len()];
    bands.flat_map_iter(cast_band).collect::<Vec<_>>().into_iter().for_each(|(place, of)| found[place] = of);
    found
}

/// The rays of one tile, by pixels (x, y).
type TileCasts = Vec<((u32, u32), Cast<f32>)>;

fn cast_tile(casting: &Casting<f32>, view: &ViewJob, tile: u32) -> TileCasts {
    let pixels: Vec<(u32, u32)> = view.pixels(tile).collect();
    let casts = cast_pixels(casting, view.rays, &pixels);
    pixels.into_iter().zip(casts).collect()
}

/// Puts the colours of a tile's rays into the rows of a picture that begin `above` from its top.
fn put_down(casts: &TileCasts, rgba: &mut [f32], width: usize, above: usize) -> TileFound {
    let mut found = TileFound { rays: casts.len() as u64, samples: 0, is_missing: false };
    for &((x, y), cast) in casts {
        let at = 4 * ((y as usize - above) * width + x as usize);
        rgba[at..at + 4].copy_from_slice(&cast.rgba);
        found.samples += u64::from(cast.samples);
        found.is_missing |= cast.is_missing;
    }
    found
}
