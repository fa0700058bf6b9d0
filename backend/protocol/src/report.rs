//! What a back-end reports of one frame.

use serde::{Deserialize, Serialize};

/// What cast the rays of a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Caster {
    /// Row planes: each screen row sampled once for many views.
    Planes {
        /// Views of the back-end.
        views: u32,
        /// Fans that these are in: views share planes with those of their own fan alone.
        fans: u32,
        /// Views whose pictures are resampled from a raster that planes can cast.
        resampled: u32,
    },
    /// Each ray alone.
    #[default]
    Rays,
    /// Each ray alone, though row planes were welcome.
    RaysBecause(String),
}

impl std::fmt::Display for Caster {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            &Self::Planes { views, fans, resampled } => {
                match fans {
                    1 => write!(f, "row planes, each for {views} views")?,
                    _ => write!(f, "row planes in {fans} groups, for {views} views")?,
                }
                match resampled {
                    0 => Ok(()),
                    _ => write!(f, "; {resampled} pictures are resampled to calibrated rasters"),
                }
            }
            Self::Rays => write!(f, "rays"),
            Self::RaysBecause(why) => write!(f, "rays: {why}"),
        }
    }
}

/// Wall-clock milliseconds per stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stages {
    /// Choosing what to load and where: feedback, cut, index.
    pub refine_ms: f64,
    /// Waiting for bricks.
    pub load_ms: f64,
    /// Moving bricks, index and tables to the device.
    pub upload_ms: f64,
    /// Casting rays.
    pub cast_ms: f64,
    /// Bringing pictures back.
    pub readback_ms: f64,
}

impl std::ops::Add for Stages {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            refine_ms: self.refine_ms + other.refine_ms,
            load_ms: self.load_ms + other.load_ms,
            upload_ms: self.upload_ms + other.upload_ms,
            cast_ms: self.cast_ms + other.cast_ms,
            readback_ms: self.readback_ms + other.readback_ms,
        }
    }
}

/// What a live frame did to the working set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Upkeep {
    /// Nodes of the cut when the frame was done, ancestors included.
    pub nodes: u64,
    /// Leaves that rays could meet.
    pub leaves: u64,
    /// Families of eight that came.
    pub splits: u64,
    /// Families of eight that went.
    pub collapses: u64,
    /// Bricks asked of the loader and not there yet.
    pub in_flight: u64,
    /// Bricks that were asked for and are not wanted any more.
    pub cancelled: u64,
    /// Leaves whose blend is on its way because detail comes or goes, there or beside them.
    pub fading: u64,
    /// The largest level-of-detail deficit that a ray met, levels; 0 if none was too coarse.
    pub largest_deficit: f64,
    /// The mean over all rays and the leaves they met, levels; what is fine enough counts 0.
    pub mean_deficit: f64,
    /// Milliseconds of feedback, priorities, restriction and weights, on one core.
    pub update_ms: f64,
}

/// What is known of pictures that are a part of the way to complete ones; sums over all projectors of the back-end, in whole
/// numbers, so that it does not matter who draws which.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refined {
    /// Units that are cast.
    pub done: u32,
    /// Pixels.
    pub pixels: u64,
    /// What may be wrong with each of them, in parts of [`Refined::UNIT`] of a linear colour's 1.
    pub spatial: u64,
    /// Pixels at which states are compared; 0 if none were.
    pub compared: u64,
    /// How far they are apart there: the newest state and this picture, or, where this picture was begun, it and the one before.
    pub change: u64,
    /// Whether the picture lacks detail that has come or is on its way.
    pub has_detail: bool,
}

impl Refined {
    /// An error of 1 is so many.
    pub const UNIT: u64 = 1 << 20;
}

/// One back-end's account of one frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameReport {
    /// Frame number.
    pub frame: u32,
    /// Which back-end, from 0.
    pub backend: u32,
    /// The projectors it drew.
    pub projectors: Vec<u32>,
    /// What cast their rays.
    pub caster: Caster,
    /// Rays cast, repeated ones counted again.
    pub rays: u64,
    /// Samples of the volume taken along them, repeated ones counted again; gradients not counted.
    pub samples: u64,
    /// Bricks the rays asked for in this frame, resident or not.
    pub bricks_wanted: u64,
    /// Bricks in the cache when the frame was done.
    pub bricks_resident: u64,
    /// Bricks loaded during the frame.
    pub bricks_loaded: u64,
    /// Bytes of voxels loaded during the frame, as decoded.
    pub bytes_loaded: u64,
    /// Distinct bricks sampled by any of the views.
    pub working_set_union: u64,
    /// The views' own counts of distinct bricks, added up; None where views were cast together, as in live frames and on a GPU.
    pub working_set_sum: Option<u64>,
    /// Whether nothing was missing: every ray found the level of detail it asked for.
    pub complete: bool,
    /// Why it is not complete; empty when it is.
    pub shortfall: String,
    /// Bricks that rays asked for and that cannot be read: their parents are shown in their place.
    pub damaged_bricks: u64,
    /// What is wrong with the first of these: a sentence each, which names file and brick.
    pub damaged: Vec<String>,
    /// What became of the working set; None in a complete frame.
    pub upkeep: Option<Upkeep>,
    /// What is known of its pictures, where they are a part of the way to complete ones.
    pub refined: Option<Refined>,
    /// Time per stage.
    pub stages: Stages,
    /// Wall-clock milliseconds of the whole frame.
    pub total_ms: f64,
}
