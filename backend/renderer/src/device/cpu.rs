//! The CPU device: the kernels' f32 twin on all cores.

use super::under_way::UnderWay;
use super::{CastJob, CastOutcome, DeviceError, Gather};
use bricks::BRICK_VOXELS;
use layout::{FeedbackEntry, NodeRecord};
use rayon::prelude::*;
use shaders::tables::Tables;
use shaders::twin::{Cast, FeedbackCell, Scene, cast_pixel};

/// The brick cache in main memory, and the last picture.
#[derive(Debug)]
pub struct CpuDevice {
    atlas: Vec<u16>,
    nodes: Vec<NodeRecord>,
    cells: Vec<u32>,
    tables: Tables,
    pixels: Vec<f32>,
    /// What the casts of this frame have reported.
    frame_feedback: Vec<FeedbackCell>,
    /// The tables of earlier frames, which are there at once.
    tables_of_frames: UnderWay<Vec<FeedbackEntry>>,
}

/// The rays of one tile.
type TileCasts = Vec<((u32, u32), Cast<f32>)>;

impl CpuDevice {
    /// A device with room for `slots` bricks.
    pub fn new(slots: u32) -> Self {
        Self {
            atlas: vec![0; slots as usize * BRICK_VOXELS],
            nodes: Vec::new(),
            cells: Vec::new(),
            tables: Tables::default(),
            pixels: Vec::new(),
            frame_feedback: Vec::new(),
            tables_of_frames: UnderWay::default(),
        }
    }

    pub(super) fn slots(&self) -> u32 {
        (self.atlas.len() / BRICK_VOXELS) as u32
    }

    pub(super) fn write_brick(&mut self, slot: u32, samples: &[u16]) {
        let start = slot as usize * BRICK_VOXELS;
        self.atlas[start..start + BRICK_VOXELS].copy_from_slice(samples);
    }

    pub(super) fn write_index(&mut self, nodes: &[NodeRecord], cells: &[u32]) {
        self.nodes = nodes.to_vec();
        self.cells = cells.to_vec();
        // What was gathered says nothing of another index.
        self.begin_feedback();
    }

    pub(super) fn write_tables(&mut self, tables: Tables) {
        self.tables = tables;
    }

    pub(super) fn cast(&mut self, job: &CastJob) -> Result<CastOutcome, DeviceError> {
        let own = match job.gather {
            Gather::Own => no_feedback(&self.nodes),
            Gather::Frame => Vec::new(),
        };
        let scene = Scene {
            view: job.view,
            nodes: &self.nodes,
            tables: &self.tables,
            needs: &job.needs,
            cells: &self.cells,
            atlas: &self.atlas,
            feedback: if job.gather == Gather::Own { &own } else { &self.frame_feedback },
        };
        let casts: Vec<TileCasts> = job.tiles.par_iter().map(|&tile| cast_tile(&scene, job, tile)).collect();
        let [width, height] = job.view.raster;
        self.pixels.resize(4 * width as usize * height as usize, 0.0);
        let mut outcome = CastOutcome::default();
        for (&tile, casts) in job.tiles.iter().zip(&casts) {
            for &((x, y), cast) in casts {
                let at = 4 * (y as usize * width as usize + x as usize);
                self.pixels[at..at + 4].copy_from_slice(&cast.rgba);
                if job.tells_counts() {
                    outcome.samples += u64::from(cast.samples);
                }
            }
            outcome.rays += casts.len() as u64;
            if job.tells_counts() && casts.iter().any(|(_, cast)| cast.is_missing) {
                outcome.missing_tiles.push(tile);
            }
        }
        outcome.feedback = own.iter().map(FeedbackCell::entry).collect();
        Ok(outcome)
    }

    pub(super) fn begin_feedback(&mut self) {
        self.frame_feedback = no_feedback(&self.nodes);
    }

    pub(super) fn end_feedback(&mut self) {
        self.tables_of_frames.start(self.frame_feedback.iter().map(FeedbackCell::entry).collect());
    }

    pub(super) fn take_feedback(&mut self) -> Result<Option<Vec<FeedbackEntry>>, DeviceError> {
        Ok(self.tables_of_frames.take(|_| true))
    }

    pub(super) fn wait_feedback(&mut self) -> Result<Option<Vec<FeedbackEntry>>, DeviceError> {
        self.take_feedback()
    }

    pub(super) fn picture(&mut self) -> Result<Vec<f32>, DeviceError> {
        Ok(self.pixels.clone())
    }
}

/// An empty table for an index.
fn no_feedback(nodes: &[NodeRecord]) -> Vec<FeedbackCell> {
    nodes.iter().map(|_| FeedbackCell::default()).collect()
}

/// Casts one tile with the widest instructions this machine has. Wider registers change no result: nothing is
/// contracted or reordered.
fn cast_tile(scene: &Scene<f32>, job: &CastJob, tile: u32) -> TileCasts {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has just been asked for AVX2.
        return unsafe { cast_tile_avx2(scene, job, tile) };
    }
    cast_tile_anywhere(scene, job, tile)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn cast_tile_avx2(scene: &Scene<f32>, job: &CastJob, tile: u32) -> TileCasts {
    cast_tile_anywhere(scene, job, tile)
}

#[inline(always)]
fn cast_tile_anywhere(scene: &Scene<f32>, job: &CastJob, tile: u32) -> TileCasts {
    let [width, height] = job.view.raster;
    let mut casts = Vec::with_capacity(64);
    for (x, y) in job.grid.pixels(tile, width, height) {
        casts.push(((x, y), cast_pixel(scene, x, y)));
    }
    casts
}
