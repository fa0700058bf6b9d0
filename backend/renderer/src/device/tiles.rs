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
    let rows = (TILE_EDGE * view.grid.lattice.step[1]) as usize;
    let tiles: Vec<u32> = view.tiles.iter().collect();
    let places = places_by_row(view, &tiles);
    let rgba = picture.par_chunks_mut(4 * width * rows);
    let bands = places.into_par_iter().zip(rgba).enumerate();
    let cast =
        |(at, (places, rgba))| Band { above: at * rows, places, rgba }.cast(casting, (view, &tiles), stop);
    let all: Vec<Vec<(usize, TileFound)>> = bands.map(cast).collect();
    let mut found = vec![None; tiles.len()];
    all.into_iter().flatten().for_each(|(place, of)| found[place] = Some(of));
    found
}

/// The places in a view's list of the tiles of each row of tiles.
fn places_by_row(view: &ViewJob, tiles: &[u32]) -> Vec<Vec<usize>> {
    let mut rows = vec![Vec::new(); view.grid.down as usize];
    for (place, tile) in tiles.iter().enumerate() {
        rows[(tile / view.grid.across) as usize].push(place);
    }
    rows
}

/// A row of tiles. They share rows of pixels, so that one thread puts down what all of them have cast.
struct Band<'a> {
    /// Rows of pixels above it.
    above: usize,
    places: Vec<usize>,
    /// Its part of the picture.
    rgba: &'a mut [f32],
}

impl Band<'_> {
    /// What each tile that was cast found, by its place.
    fn cast(
        mut self,
        casting: &Casting<f32>,
        (view, tiles): (&ViewJob, &[u32]),
        stop: StopAsked,
    ) -> Vec<(usize, TileFound)> {
        let cast = |&place: &usize| (!stop()).then(|| (place, cast_tile(casting, view, tiles[place])));
        let casts: Vec<(usize, TileCasts)> = self.places.par_iter().filter_map(cast).collect();
        let width = view.rays.raster[0] as usize;
        casts.into_iter().map(|(place, casts)| (place, self.put_down(&casts, width))).collect()
    }

    /// Puts down the colours of a tile's rays in a picture of so many pixels across.
    fn put_down(&mut self, casts: &TileCasts, width: usize) -> TileFound {
        let mut found = TileFound { rays: casts.len() as u64, samples: 0, is_missing: false };
        for &((x, y), cast) in casts {
            let at = 4 * ((y as usize - self.above) * width + x as usize);
            self.rgba[at..at + 4].copy_from_slice(&cast.rgba);
            found.samples += u64::from(cast.samples);
            found.is_missing |= cast.is_missing;
        }
        found
    }
}

/// The rays of one tile, by pixels (x, y).
type TileCasts = Vec<((u32, u32), Cast<f32>)>;

fn cast_tile(casting: &Casting<f32>, view: &ViewJob, tile: u32) -> TileCasts {
    let pixels: Vec<(u32, u32)> = view.pixels(tile).collect();
    let casts = cast_pixels(casting, view.rays, &pixels);
    pixels.into_iter().zip(casts).collect()
}
