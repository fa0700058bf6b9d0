//! The messages themselves.

use super::{DeviceInfo, FrameReport, FrameState, Hello, ProjectorImage, Setup};
use serde::{Deserialize, Serialize};

/// Both ends must agree on it.
pub const PROTOCOL_VERSION: u32 = 8;

/// From the front-end to a back-end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromFrontend {
    /// Open the volume and the device.
    Setup(Box<Setup>),
    /// Draw this frame; one that is being drawn is dropped for it.
    Frame(Box<FrameState>),
    /// The front-end is alive; nothing to do.
    Alive,
    /// No frame follows: complete what is written beside the pictures, and say so.
    Finish,
    /// Finish.
    Quit,
}

/// From a back-end to the front-end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromBackend {
    /// It started.
    Hello(Hello),
    /// It is set up and waits for a frame.
    Ready(DeviceInfo),
    /// Still at work; `done` of `total` rays of the frame are final.
    Progress {
        /// Rays that are final.
        done: u64,
        /// Rays of the frame.
        total: u64,
    },
    /// A picture of the current frame is final.
    Image(ProjectorImage),
    /// The current frame is done; all its pictures have been sent.
    Done(Box<FrameReport>),
    /// What it wrote beside the pictures is complete.
    Finished,
    /// It cannot go on: one sentence.
    Failed(String),
    /// At work, with nothing new to say.
    Alive,
}
