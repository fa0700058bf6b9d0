//! The lines of a trace.

use super::Demand;
use bricks::LodRule;
use bricks::{NodeKey, OctreeShape};
use display_config::Display;
use glam::{DAffine3, UVec3};
use optics::Optics;
use protocol::{FrameState, VolumeRef};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What the first line calls itself.
pub(super) const FORMAT: &str = "lightloom trace";
/// The version that is written, and the only one read.
pub(super) const VERSION: u32 = 1;

/// What a trace was recorded of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TraceHeader {
    /// The volume.
    pub volume: VolumeRef,
    /// Its voxels along each axis.
    pub dims: UVec3,
    /// Name of the display.
    pub display: String,
    /// s0 of the display, metres.
    pub pixel_size_m: f64,
    /// Φ of the display, radians.
    pub angular_accuracy: f64,
}

/// A frame of a trace.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedFrame {
    /// Frame number.
    pub index: u32,
    /// Time of the frame on the scene's clock, seconds.
    pub time_s: f64,
    /// Volume frame (finest voxels) to display frame (metres).
    pub display_from_volume: DAffine3,
    /// See [`optics::Quality::lod_scale`].
    pub lod_scale: f64,
    /// What scalars look like, and so which nodes are empty.
    pub optics: Arc<Optics>,
    /// What rays sampled.
    pub demand: Demand,
}

impl TraceHeader {
    /// The header for a volume on a display.
    pub fn new(volume: VolumeRef, shape: &OctreeShape, display: &Display) -> Self {
        Self {
            volume,
            dims: shape.dims(),
            display: display.name.clone(),
            pixel_size_m: display.pixel_size_m,
            angular_accuracy: display.angular_accuracy,
        }
    }

    /// The octree that the nodes are of.
    pub fn shape(&self) -> OctreeShape {
        OctreeShape::new(self.dims)
    }
}

impl TracedFrame {
    /// How fine nodes had to be in this frame.
    pub fn lod_rule(&self, header: &TraceHeader) -> LodRule {
        LodRule {
            display_from_volume: self.display_from_volume,
            pixel_size_m: header.pixel_size_m,
            angular_accuracy: header.angular_accuracy,
            lod_scale: self.lod_scale,
        }
    }
}

/// The first line.
#[derive(Serialize, Deserialize)]
pub(super) struct HeaderLine {
    pub(super) format: String,
    pub(super) version: u32,
    #[serde(flatten)]
    pub(super) header: TraceHeader,
}

/// A node as a line holds it: depth, x, y, z, rays.
pub(super) type NodeNumbers = (u8, u32, u32, u32, u32);

/// Any further line.
#[derive(Serialize, Deserialize)]
pub(super) struct FrameLine {
    pub(super) index: u32,
    pub(super) time_s: f64,
    pub(super) display_from_volume: DAffine3,
    pub(super) lod_scale: f64,
    /// Left out where they are those of the line before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) optics: Option<Optics>,
    pub(super) demand: Vec<NodeNumbers>,
}

impl FrameLine {
    pub(super) fn new(frame: &FrameState, optics: Option<Optics>, demand: &Demand) -> Self {
        let numbers = |key: NodeKey, rays| (key.depth, key.cell.x, key.cell.y, key.cell.z, rays);
        Self {
            index: frame.index,
            time_s: frame.time_s,
            display_from_volume: frame.display_from_volume,
            lod_scale: frame.quality.lod_scale,
            optics,
            demand: demand.nodes().iter().map(|node| numbers(node.key, node.rays)).collect(),
        }
    }
}
