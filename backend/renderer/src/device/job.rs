//! One cast: which rays, with which kernel, and what they found.

use layout::{FeedbackEntry, TILE_EDGE};
use needs::Needs;
use planes::Fan;
use protocol::StopAsked;
use std::borrow::Cow;
use twin::{ProjectorRays, SceneNumbers};

/// The tiles of a raster: squares of 8 × 8 cast pixels, `stride` pixels apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileGrid {
    /// Pixels between cast rays.
    pub stride: u32,
    /// Tiles along x.
    pub across: u32,
    /// Tiles along y.
    pub down: u32,
}

impl TileGrid {
    /// The grid of a raster of `width` × `height` pixels.
    pub fn new(width: u32, height: u32, stride: u32) -> Self {
        let edge = TILE_EDGE * stride;
        Self { stride, across: width.div_ceil(edge), down: height.div_ceil(edge) }
    }

    /// Tiles there are.
    pub fn count(&self) -> u32 {
        self.across * self.down
    }

    /// How many pixels a tile casts, within a raster of `width` × `height`.
    pub fn rays(&self, tile: u32, width: u32, height: u32) -> u64 {
        let along = |place: u32, pixels: u32| {
            let rays = pixels.saturating_sub(self.stride / 2).div_ceil(self.stride);
            u64::from(rays.saturating_sub(place * TILE_EDGE).min(TILE_EDGE))
        };
        along(tile % self.across, width) * along(tile / self.across, height)
    }

    /// The pixels that a tile casts, within a raster of `width` × `height`.
    pub fn pixels(&self, tile: u32, width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
        let (grid, first) = (*self, (tile % self.across * TILE_EDGE, tile / self.across * TILE_EDGE));
        (0..TILE_EDGE * TILE_EDGE)
            .map(move |i| {
                let at = |first: u32, i: u32| (first + i) * grid.stride + grid.stride / 2;
                (at(first.0, i % TILE_EDGE), at(first.1, i / TILE_EDGE))
            })
            .filter(move |&(x, y)| x < width && y < height)
    }
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
    /// The middle one of every `stride` × `stride` pixels.
    Every {
        /// Pixels between cast rays: 1 casts them all.
        stride: u32,
    },
    /// The same of some tiles.
    Tiles {
        /// Pixels between cast rays.
        stride: u32,
        /// View by view.
        tiles: &'a [Vec<u32>],
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
    /// What the rows of its views share, where they are cast in their planes; None for each ray alone.
    pub fan: Option<&'a Fan>,
    /// Which pixels.
    pub part: Part<'a>,
    /// Where its feedback goes.
    pub gather: Gather,
    /// Whether to count samples and list missing tiles (full-resolution casts only; makes a GPU cast blocking).
    pub counts: bool,
    /// Asked before each tile whether to leave the others; a GPU asks before each batch of tiles.
    pub stop: StopAsked<'a>,
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
    pub(super) tiles: Cow<'a, [u32]>,
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
            Part::Every { stride } => {
                let grid = TileGrid::new(width, height, stride);
                ViewJob { picture, rays, grid, tiles: (0..grid.count()).collect() }
            }
            Part::Tiles { stride, tiles } => {
                let tiles = tiles.get(index).map_or(&[][..], Vec::as_slice);
                ViewJob { picture, rays, grid: TileGrid::new(width, height, stride), tiles: tiles.into() }
            }
        }
    }

    /// Pixels between cast rays.
    pub(super) fn stride(&self) -> u32 {
        match self.part {
            Part::Every { stride } | Part::Tiles { stride, .. } => stride,
        }
    }

    /// Whether samples are counted and missing tiles listed.
    pub(super) fn has_counts(&self) -> bool {
        self.counts && self.stride() == 1
    }
}

impl ViewJob<'_> {
    /// Rays that it casts.
    #[cfg(feature = "gpu")]
    pub(super) fn ray_count(&self) -> u64 {
        let [width, height] = self.rays.raster;
        self.tiles.iter().map(|&tile| self.grid.rays(tile, width, height)).sum()
    }

    /// The pixels that a tile casts.
    pub(super) fn pixels(&self, tile: u32) -> impl Iterator<Item = (u32, u32)> {
        let [width, height] = self.rays.raster;
        self.grid.pixels(tile, width, height)
    }
}

/// What a cast found.
#[derive(Clone, Debug, Default)]
pub struct CastOutcome {
    /// One per place of the index; empty if the frame's table has it.
    pub feedback: Vec<FeedbackEntry>,
    /// View by view, the tiles of which a ray met a node that is too coarse; empty where they were not asked for.
    pub missing_tiles: Vec<Vec<u32>>,
    /// View by view, the tiles that were left.
    pub left: Vec<Vec<u32>>,
    /// Rays cast.
    pub rays: u64,
    /// Samples taken; 0 where they were not asked for.
    pub samples: u64,
}

impl CastOutcome {
    /// Before anything is found.
    pub(super) fn nothing(job: &CastJob) -> Self {
        let lists = if job.has_counts() { job.views.len() } else { 0 };
        let left = vec![Vec::new(); job.views.len()];
        Self { missing_tiles: vec![Vec::new(); lists], left, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rays_of_a_tile_are_the_pixels_it_casts() {
        for (width, height) in [(1, 1), (7, 9), (48, 36), (33, 64), (130, 17)] {
            for stride in [1, 2, 3, 16] {
                let grid = TileGrid::new(width, height, stride);
                for tile in 0..grid.count() {
                    let cast = grid.pixels(tile, width, height).count() as u64;
                    assert_eq!(grid.rays(tile, width, height), cast, "{width} {height} {stride} {tile}");
                }
            }
        }
    }
}
