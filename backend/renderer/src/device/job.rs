//! One cast: which rays, with which kernel, and what they found.

use layout::{FeedbackEntry, TILE_EDGE};
use shaders::compose::Needs;
use shaders::twin::View;

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
    /// Into the table of the frame, see [`super::Device::begin_feedback`]; the outcome holds none.
    Frame,
}

/// One cast.
#[derive(Clone, Copy, Debug)]
pub struct CastJob<'a> {
    /// The view, in f32.
    pub view: &'a View<f32>,
    /// What the scene needs of a kernel.
    pub needs: Needs,
    /// The raster's tiles.
    pub grid: TileGrid,
    /// Those to cast.
    pub tiles: &'a [u32],
    /// Where its feedback goes.
    pub gather: Gather,
    /// Whether to report sample counts and missing tiles (full-resolution casts only; makes a GPU cast blocking).
    pub counts: bool,
}

impl CastJob<'_> {
    /// Rays that it casts.
    #[cfg(feature = "gpu")]
    pub(super) fn rays(&self) -> u64 {
        let [width, height] = self.view.raster;
        self.tiles.iter().map(|&tile| self.grid.rays(tile, width, height)).sum()
    }

    /// Whether to report sample counts and missing tiles.
    pub(super) fn tells_counts(&self) -> bool {
        self.counts && self.grid.stride == 1
    }
}

/// What a cast found.
#[derive(Clone, Debug, Default)]
pub struct CastOutcome {
    /// One per place of the index; empty if the frame's table has it.
    pub feedback: Vec<FeedbackEntry>,
    /// Tiles of which a ray met a node that is too coarse; empty if it was not asked for.
    pub missing_tiles: Vec<u32>,
    /// Rays cast.
    pub rays: u64,
    /// Samples taken; 0 if it was not asked for.
    pub samples: u64,
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
