//! The messages themselves.

use super::{DeviceInfo, FrameReport, FrameState, Held, Hello, ProjectorImage, ScreenImage, Setup};
use serde::{Deserialize, Serialize};

/// Both ends must agree on it.
pub const PROTOCOL_VERSION: u32 = 16;

/// From the front-end to a back-end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromFrontend {
    /// Open the volume and the device.
    Setup(Box<Setup>),
    /// Draw this frame; one that is being drawn is dropped for it.
    Frame(Box<FrameState>),
    /// Draw this frame for the screens. While another is drawn it waits, and takes the place of one that waits.
    Beat {
        /// The frame.
        frame: Box<FrameState>,
        /// What rays would see by now, if that is something else, where the frame is a part of the way to a picture: how far
        /// it is from that is told from a few rays.
        newest: Option<Box<FrameState>>,
    },
    /// Show a frame of the beat, drawn or not: one that is drawn late is shown at once.
    Show {
        /// Its number.
        frame: u32,
        /// When, on the back-end's clock, microseconds; None is as soon as it can be.
        at_us: Option<u64>,
    },
    /// What does the back-end's clock say?
    Clock {
        /// What the front-end's says now, microseconds: it comes back with the answer.
        asked_us: u64,
    },
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
    /// What screens will show of a frame of the beat, if the setup asks for it; before the frame is drawn.
    Screen(ScreenImage),
    /// A frame of the beat is drawn, and waits to be shown.
    Drawn(Box<FrameReport>),
    /// A frame of the beat is shown.
    Shown {
        /// Its number.
        frame: u32,
        /// Since when, on the back-end's clock, microseconds.
        at_us: u64,
    },
    /// The answer to a question for the clock.
    Clock {
        /// What the front-end's clock said when it asked, microseconds.
        asked_us: u64,
        /// What the back-end's clock says, microseconds.
        here_us: u64,
    },
    /// Something has happened that whoever runs the show should know, and the show goes on: one sentence.
    Said(String),
    /// What it shows by now, for whoever takes its place: whoever would start that one again keeps it, and tells nobody else.
    Held(Box<Held>),
    /// What it wrote beside the pictures is complete.
    Finished,
    /// It cannot go on: one sentence.
    Failed(String),
    /// From its keeper: it has ended, how in a sentence, and is started again. It says hello as it did at first.
    Lost(String),
    /// At work, with nothing new to say.
    Alive,
}
