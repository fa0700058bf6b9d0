//! What draws frames, and what happens while it does.

use crate::{FrameReport, FrameState, ProjectorImage};

/// What happens while a frame is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum RenderEvent {
    /// `done` of `total` rays of the frame are final.
    Progress {
        /// Rays that are final.
        done: u64,
        /// Rays of the frame.
        total: u64,
    },
    /// The picture of a projector is final.
    Image(ProjectorImage),
}

/// Something that draws frames.
pub trait Draw {
    /// Draws one frame and gives each finished picture to `sink`. Report progress to `sink` at least once per second:
    /// that shows the front-end that this back-end is alive. An error is one sentence, and ends the run.
    fn draw(&mut self, frame: &FrameState, sink: &mut dyn FnMut(RenderEvent)) -> Result<FrameReport, String>;

    /// No frame follows: completes what it writes beside the pictures. An error is one sentence, and fails the run.
    fn finish(&mut self) -> Result<(), String> {
        Ok(())
    }
}
