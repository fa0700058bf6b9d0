//! What a study of accuracy is about.

use bricks::BrickSource;
use display_config::Display;
use protocol::{DeviceChoice, FrameState};
use std::sync::Arc;

/// What is measured.
pub struct Study {
    /// The display.
    pub display: Display,
    /// The frame; its own quality is tried, too.
    pub frame: FrameState,
    /// The volume.
    pub source: Arc<dyn BrickSource>,
    /// The projectors whose pictures are compared and timed; at least one.
    pub projectors: Vec<u32>,
    /// Every how many pixels along x and y are compared; None for as many as half a minute of truth allows.
    pub stride: Option<u32>,
    /// How often each setting is timed: an odd number.
    pub repetitions: u32,
    /// Whether every combination is tried.
    pub is_full: bool,
    /// Whether the default setting, and those around it, are taken at the finest level.
    pub is_finest: bool,
    /// The device.
    pub device: DeviceChoice,
    /// Its brick cache, bytes.
    pub cache_bytes: u64,
}
