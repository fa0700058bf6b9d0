//! The course of a frame: cast what is pending, then do what comes next, until it is done.

use super::RenderError;
use super::complete::Complete;
use super::engine::Engine;
use super::live::LiveFrame;
use super::work::Work;
use protocol::{FrameReport, Pace, StopAsked};

/// What comes after a cast.
#[derive(Debug)]
enum Next {
    /// Rounds until nothing is missing.
    Complete(Complete),
    /// One round.
    Live(LiveFrame),
}

/// A frame and its course.
#[derive(Debug)]
pub(super) struct Course {
    pub(super) work: Work,
    next: Next,
    report: Option<FrameReport>,
}

impl Course {
    pub(super) fn new(work: Work) -> Self {
        let next = match work.frame.pace {
            Pace::Complete => Next::Complete(Complete::default()),
            Pace::Live { upload_bytes, fade_s } => Next::Live(LiveFrame::new(upload_bytes, fade_s)),
        };
        Self { work, next, report: None }
    }

    /// The account of the frame, once it is done.
    pub(super) fn report(&self) -> Option<Box<FrameReport>> {
        self.report.clone().map(Box::new)
    }

    /// Goes on until `stop` asks to leave off, a picture has become final, or the frame is done.
    pub(super) fn go_on(&mut self, engine: &mut Engine, stop: StopAsked) -> Result<(), RenderError> {
        while self.work.finals.is_empty() && self.report.is_none() && !stop() {
            if !self.work.pending.is_empty() {
                self.work.cast(engine, stop)?;
                continue;
            }
            self.report = match &mut self.next {
                Next::Complete(complete) => complete.next(&mut self.work, engine, stop)?,
                Next::Live(live) => live.next(&mut self.work, engine)?,
            };
        }
        Ok(())
    }
}
