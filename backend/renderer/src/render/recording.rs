//! The trace of what rays of live frames asked for, if one is wanted.

use super::RenderError;
use crate::device::MOST_UNDER_WAY;
use crate::working_set::{TraceError, TraceHeader, TraceWriter};
use bricks::{NodeKey, OctreeShape};
use protocol::{FrameState, Setup, VolumeRef};
use std::collections::VecDeque;
use std::path::PathBuf;

/// It begins with the first live frame and gets its name at the end.
#[derive(Debug)]
pub(super) struct Recording {
    /// Where, and of what; None if no trace is wanted.
    wanted: Option<(PathBuf, TraceHeader)>,
    writer: Option<TraceWriter>,
    /// Frames whose rays have not reported yet: with a GPU that takes a few frames.
    frames: VecDeque<FrameState>,
}

impl Recording {
    pub(super) fn new(setup: &Setup, shape: &OctreeShape) -> Self {
        // Whoever reads the trace may be in another folder.
        let volume = match &setup.volume {
            VolumeRef::Store(path) => {
                VolumeRef::Store(std::path::absolute(path).unwrap_or_else(|_| path.clone()))
            }
            procedural => procedural.clone(),
        };
        let header = || TraceHeader::new(volume, shape, &setup.display);
        let wanted = setup.trace.clone().map(|path| (path, header()));
        Self { wanted, writer: None, frames: VecDeque::new() }
    }

    /// The rays of a live frame are on their way; `now_s` is its time on a clock that does not run back.
    pub(super) fn began(&mut self, frame: &FrameState, now_s: f64) -> Result<(), RenderError> {
        let Some((path, header)) = &self.wanted else { return Ok(()) };
        if self.writer.is_none() {
            self.writer = Some(TraceWriter::create(path, header.clone())?);
        }
        self.frames.push_back(FrameState { time_s: now_s, ..frame.clone() });
        // Of the device's tables, too, the oldest are given up.
        if self.frames.len() > MOST_UNDER_WAY {
            self.frames.pop_front();
        }
        Ok(())
    }

    /// The rays of the oldest frame on its way have reported what they sampled.
    pub(super) fn told(&mut self, sampled: impl Iterator<Item = (NodeKey, u32)>) -> Result<(), RenderError> {
        if let (Some(writer), Some(frame)) = (&mut self.writer, self.frames.pop_front()) {
            writer.frame(&frame, sampled)?;
        }
        Ok(())
    }

    /// What is on its way will not arrive.
    pub(super) fn forget(&mut self) {
        self.frames.clear();
    }

    /// Gives the trace its name.
    pub(super) fn finish(&mut self) -> Result<(), RenderError> {
        self.wanted = None;
        Ok(self.writer.take().map_or(Ok(()), TraceWriter::finish)?)
    }
}

impl From<TraceError> for RenderError {
    fn from(error: TraceError) -> Self {
        Self::Trace(error.to_string())
    }
}
