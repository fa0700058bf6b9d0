//! One cast: which rays, with which kernel, and what they found.

use super::TileList;
use layout::{FeedbackEntry, TILE_EDGE};
use needs::Needs;
use optics::Enhancer;
use planes::Fans;
use protocol::StopAsked;
use std::borrow::Cow;
use std::ops::Range;
use twin::{Lattice, ProjectorRays, SceneNumbers, ShortRay};

/// The tiles of a raster: squares of 8 × 8 cast pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileGrid {
    /// The cast pixels.
    pub lattice: Lattice,
    /// Tiles along x.
    pub across: u32,
    /// Tiles along y.
    pub down: u32,
}

impl TileGrid {
    /// The grid of a raster of `width` × `height` pixels.
    pub fn new(width: u32, height: u32, lattice: Lattice) -> Self {
        let tiles = |pixels, axis| cast_along(&lattice, axis, pixels).div_ceil(TILE_EDGE);
        Self { lattice, across: tiles(width, 0), down: tiles(height, 1) }
    }

    /// Tiles there are.
    pub fn count(&self) -> u32 {
        self.across * self.down
    }

    /// How many pixels neighbouring tiles cast, within a raster of `width` × `height`.
    pub fn rays(&self, tiles: &Range<u32>, width: u32, height: u32) -> u64 {
        let [columns, rows] = [(0, width), (1, height)].map(|(axis, n)| cast_along(&self.lattice, axis, n));
        // Those before a tile, in its row and in all above.
        let before = |tile: u32| {
            let [x, y] = [tile % self.across, tile / self.across].map(|place| place * TILE_EDGE);
            let row = u64::from(rows.saturating_sub(y).min(TILE_EDGE));
            u64::from(y.min(rows)) * u64::from(columns) + u64::from(x.min(columns)) * row
        };
        if tiles.is_empty() { 0 } else { before(tiles.end) - before(tiles.start) }
    }

    /// The pixels that a tile casts, within a raster of `width` × `height`: neighbours one after another, in blocks of 4 × 2.
    pub fn pixels(&self, tile: u32, width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
        let Lattice { step, first } = self.lattice;
        let corner = [tile % self.across * TILE_EDGE, tile / self.across * TILE_EDGE];
        (0..TILE_EDGE * TILE_EDGE)
            .map(move |i| {
                let at = |axis: usize, i: u32| (corner[axis] + i) * step[axis] + first[axis];
                (at(0, i % 4 + i / 8 % (TILE_EDGE / 4) * 4), at(1, i / 4 % 2 + i / TILE_EDGE / 2 * 2))
            })
            .filter(move |&(x, y)| x < width && y < height)
    }
}

/// How many of `pixels` in a row along an axis are cast.
fn cast_along(lattice: &Lattice, axis: usize, pixels: u32) -> u32 {
    pixels.saturating_sub(lattice.first[axis]).div_ceil(lattice.step[axis])
}

/// The middle one of every `stride` × `stride` pixels.
pub fn coarse(stride: u32) -> Lattice {
    Lattice { step: [stride; 2], first: [stride / 2; 2] }
}

/// Where the feedback of a cast goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gather {
    /// Into a table of its own, which the outcome holds.
    Own,
    /// Into the table of the frame, see [`super::Device::clear_feedback`]; the outcome holds none.
    Frame,
}

/// Which pixels of its views a cast casts.
#[derive(Clone, Copy, Debug)]
pub enum Part<'a> {
    /// All of a lattice.
    Every(Lattice),
    /// Some tiles of it.
    Tiles {
        /// The lattice.
        lattice: Lattice,
        /// View by view.
        tiles: &'a [TileList],
    },
}

/// A cast that is not to be left off.
pub const NEVER: StopAsked = &|| false;

/// One cast: the same scene for some projectors.
#[derive(Clone, Copy)]
pub struct CastJob<'a> {
    /// The scene, in f32.
    pub scene: &'a SceneNumbers<f32>,
    /// The projectors' rays, in f32.
    pub views: &'a [ProjectorRays<f32>],
    /// Index among the device's pictures of that of the first view; those of the others follow.
    pub first_picture: usize,
    /// What the scene needs of a kernel.
    pub needs: Needs,
    /// How the views share planes, where these are cast, whole rows at a time; None for each ray alone.
    pub sharing: Option<Sharing<'a>>,
    /// Which pixels.
    pub part: Part<'a>,
    /// Whether pictures that planes have cast are mended: the views and tiles are then those of the projectors' own rasters, and
    /// rays are cast for those of their pixels alone that cannot be resampled well. Their colours come with the outcome.
    pub mends: bool,
    /// Where its feedback goes.
    pub gather: Gather,
    /// Whether to count samples and list missing tiles.
    pub counts: bool,
    /// Asked before each tile whether to leave the others; a GPU asks before each batch of tiles.
    pub stop: StopAsked<'a>,
}

/// How views share row planes.
#[derive(Clone, Copy, Debug)]
pub struct Sharing<'a> {
    /// Which views share which planes.
    pub fans: &'a Fans,
    /// The enhancers of the scene: what they multiply extinction by says how closely planes are sampled.
    pub enhancers: &'a [Enhancer],
}

/// Some rays of projectors that end early, for marks that the volume may hide.
#[derive(Clone, Copy, Debug)]
pub struct ShortJob<'a> {
    /// The scene, in f32.
    pub scene: &'a SceneNumbers<f32>,
    /// What the scene needs of a kernel.
    pub needs: Needs,
    /// Of these projectors.
    pub views: &'a [ShortView<'a>],
}

/// Those of one projector.
#[derive(Clone, Debug)]
pub struct ShortView<'a> {
    /// The projector's rays, in f32.
    pub rays: &'a ProjectorRays<f32>,
    /// The short ones.
    pub short: Vec<ShortRay>,
}

/// What a cast casts of one view.
#[derive(Clone, Debug)]
pub(super) struct ViewJob<'a> {
    /// Index of its picture.
    pub(super) picture: usize,
    /// Its rays.
    pub(super) rays: &'a ProjectorRays<f32>,
    /// Its tiles.
    pub(super) grid: TileGrid,
    /// Those to cast; at least one.
    pub(super) tiles: Cow<'a, TileList>,
}

impl CastJob<'_> {
    /// What to cast of each view, those without tiles left out; with the view's index.
    pub(super) fn view_jobs(&self) -> impl Iterator<Item = (usize, ViewJob<'_>)> {
        let jobs = self.views.iter().enumerate().map(|(index, rays)| (index, self.view_job(index, rays)));
        jobs.filter(|(_, view)| !view.tiles.is_empty())
    }

    fn view_job<'a>(&'a self, index: usize, rays: &'a ProjectorRays<f32>) -> ViewJob<'a> {
        let [width, height] = rays.raster;
        let picture = self.first_picture + index;
        match self.part {
            Part::Every(lattice) => {
                let grid = TileGrid::new(width, height, lattice);
                ViewJob { picture, rays, grid, tiles: Cow::Owned(TileList::all(grid.count())) }
            }
            Part::Tiles { lattice, tiles } => {
                let tiles = tiles.get(index).map_or_else(Cow::default, Cow::Borrowed);
                ViewJob { picture, rays, grid: TileGrid::new(width, height, lattice), tiles }
            }
        }
    }

    /// The pixels that are cast.
    pub(super) fn lattice(&self) -> Lattice {
        match self.part {
            Part::Every(lattice) | Part::Tiles { lattice, .. } => lattice,
        }
    }
}

impl ViewJob<'_> {
    /// The row of tiles that each of its tiles is in.
    pub(super) fn rows_of_tiles(&self) -> impl Iterator<Item = u32> {
        self.tiles.iter().map(|tile| tile / self.grid.across)
    }

    /// Rays that it casts.
    #[cfg(feature = "gpu")]
    pub(super) fn ray_count(&self) -> u64 {
        let [width, height] = self.rays.raster;
        self.tiles.runs().iter().map(|run| self.grid.rays(run, width, height)).sum()
    }

    /// The pixels that a tile casts.
    pub(super) fn pixels(&self, tile: u32) -> impl Iterator<Item = (u32, u32)> {
        let [width, height] = self.rays.raster;
        self.grid.pixels(tile, width, height)
    }
}

/// Some pixels of a picture: the place of each, row by row, and its colour.
pub type Patch = Vec<(u32, [f32; 4])>;

/// What a cast found.
#[derive(Clone, Debug, Default)]
pub struct CastOutcome {
    /// One per place of the index; empty if the frame's table has it.
    pub feedback: Vec<FeedbackEntry>,
    /// View by view, the tiles of which a ray met a node that is too coarse; empty where they were not asked for.
    pub missing_tiles: Vec<TileList>,
    /// View by view, the tiles that were left.
    pub left: Vec<TileList>,
    /// View by view, pixels that were mended.
    pub mended: Vec<Patch>,
    /// Rays cast.
    pub rays: u64,
    /// Samples taken; 0 where they were not asked for.
    pub samples: u64,
    /// Rays that a GPU's driver left before their end; 0 where samples were not asked for.
    pub cut: u64,
}

impl CastOutcome {
    /// Before anything is found.
    pub(super) fn nothing(job: &CastJob) -> Self {
        let lists = if job.counts { job.views.len() } else { 0 };
        let left = vec![TileList::default(); job.views.len()];
        let mended = vec![Patch::default(); if job.mends { job.views.len() } else { 0 }];
        Self { missing_tiles: vec![TileList::default(); lists], left, mended, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rays_of_a_tile_are_the_pixels_it_casts() {
        for (width, height) in [(1, 1), (7, 9), (48, 36), (33, 64), (130, 17)] {
            let odd = Lattice { step: [2, 2], first: [1, 0] };
            let rows = Lattice { step: [1, 2], first: [0, 1] };
            for lattice in [Lattice::ALL, coarse(3), coarse(16), odd, rows] {
                let grid = TileGrid::new(width, height, lattice);
                let casts = |tile| grid.pixels(tile, width, height).count() as u64;
                let all = 0..grid.count();
                assert_eq!(grid.rays(&all, width, height), all.map(casts).sum::<u64>());
                for tile in 0..grid.count() {
                    let cast = casts(tile);
                    assert_eq!(
                        grid.rays(&(tile..tile + 1), width, height),
                        cast,
                        "{width} {height} {lattice:?} {tile}"
                    );
                }
            }
        }
    }
}
