//! What draws frames, whole or in pieces, and what happens while it does.

use crate::{FrameReport, FrameState, Held, ProjectorImage, ScreenPicture};

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

/// Why a frame cannot be drawn: one sentence. Nothing can be drawn after it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct DrawError(pub String);

/// Something that draws whole frames: a renderer, or a session with back-ends that have one each.
pub trait Draw {
    /// Draws one frame and hands each finished picture to `sink`, with news of the progress in between. One report per
    /// back-end, in their order.
    ///
    /// # Errors
    /// One sentence; it ends the run.
    fn draw(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<Vec<FrameReport>, DrawError>;

    /// No frame follows: completes what is written beside the pictures.
    ///
    /// # Errors
    /// One sentence; it fails the run.
    fn finish(&mut self) -> Result<(), DrawError> {
        Ok(())
    }
}

/// Asked before each tile whether to leave off for now.
pub type StopAsked<'a> = &'a (dyn Fn() -> bool + Sync);

/// How far a frame has come.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Advance {
    /// Rays that are final.
    pub done: u64,
    /// Rays of the frame.
    pub total: u64,
    /// Bricks that the frame has asked for and that have not come.
    pub lacking_bricks: u64,
    /// The account of the frame, once nothing is left to do.
    pub report: Option<Box<FrameReport>>,
}

/// Where the codes of pictures are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodesAt {
    /// In main memory.
    pub host: bool,
    /// In the memory of the device that makes them; only a renderer that has swapchains can leave them there.
    pub device: bool,
}

impl CodesAt {
    /// In main memory alone.
    pub const HOST: Self = Self { host: true, device: false };
}

/// Something that draws a frame in pieces, and can be interrupted between any two tiles.
pub trait Render {
    /// Begins a frame, and drops what is unfinished of the one before.
    ///
    /// # Errors
    /// The frame cannot be drawn.
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError>;

    /// What rays would see by now, if that is something else than the frame that was begun, a part of the way to a picture:
    /// its report will say how far it is from that.
    fn compare_with(&mut self, _newest: &FrameState) {}

    /// Goes on with the frame until `stop` asks to leave off, a picture has become final, or the frame is done.
    ///
    /// # Errors
    /// Nothing can be drawn any more.
    fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError>;

    /// Hands over the pictures that have become final since it was last called.
    ///
    /// # Errors
    /// A picture cannot be read back.
    fn present(&mut self, sink: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError>;

    /// The same, as screens show them: each picture once for each place where its codes are wanted.
    ///
    /// # Errors
    /// A picture cannot be read back.
    fn present_on_screens(
        &mut self,
        at: CodesAt,
        sink: &mut dyn FnMut(ScreenPicture),
    ) -> Result<(), DrawError>;

    /// What it shows, where that may be something else than when it was last asked, for one that takes its place.
    fn held(&mut self) -> Option<Held> {
        None
    }

    /// No frame follows: completes what is written beside the pictures.
    ///
    /// # Errors
    /// It cannot be written.
    fn finish(&mut self) -> Result<(), DrawError> {
        Ok(())
    }
}
