//! What draws frames.

use crate::FrontendError;
use protocol::{FrameReport, FrameState, ProjectorImage};

/// What happens while a frame is drawn.
#[derive(Clone, Debug)]
pub enum Event {
    /// `done` of `total` rays of one back-end's part of the frame are final.
    Progress {
        /// Which back-end, from 0.
        backend: usize,
        /// Rays that are final.
        done: u64,
        /// Rays of its part.
        total: u64,
    },
    /// A picture is final.
    Image(ProjectorImage),
}

/// Something that draws frames: back-ends in this process or elsewhere, or a fake in tests.
pub trait FrameSource {
    /// Draws a frame, passing each picture to `on_event` once. Returns one report per back-end, in their order.
    fn render(
        &mut self,
        frame: &FrameState,
        on_event: &mut dyn FnMut(Event),
    ) -> Result<Vec<FrameReport>, FrontendError>;

    /// Lets the back-ends go.
    fn finish(self: Box<Self>) -> Result<(), FrontendError>;
}
