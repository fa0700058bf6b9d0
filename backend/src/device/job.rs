//! One cast: which rays, with which kernel, and what they found.

use shaders::compose::Needs;
use shaders::layout::{FeedbackEntry, TILE_EDGE};
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
}

/// What a cast found.
#[derive(Clone, Debug, Default)]
pub struct CastOutcome {
    /// One per place of the index.
    pub feedback: Vec<FeedbackEntry>,
    /// Tiles of which a ray met a node that is too coarse; told only where every pixel is cast.
    pub missing_tiles: Vec<u32>,
    /// Rays cast.
    pub rays: u64,
    /// Samples taken; told only where every pixel is cast.
    pub samples: u64,
}
