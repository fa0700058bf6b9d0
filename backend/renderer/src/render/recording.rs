//! The trace of what rays of live frames asked for, if one is wanted.

use super::RenderError;
use crate::working_set::{TraceHeader, TraceWriter};
use bricks::{NodeKey, OctreeShape};
use display_config::Display;
use protocol::{FrameState, VolumeRef};
use std::path::PathBuf;

/// It begins with the first live frame and gets its name at the end.
#[derive(Debug, Default)]
pub(super) struct Recording {
    /// Where, and of what; None if no trace is wanted.
    wanted: Option<(PathBuf, TraceHeader)>,
    writer: Option<TraceWriter>,
}

impl Recording {
    pub(super) fn new(path: PathBuf, volume: &VolumeRef, shape: &OctreeShape, display: &Display) -> Self {
        // Whoever reads the trace may be in another folder.
        let volume = match volume {
            VolumeRef::Store(path) => {
                VolumeRef::Store(std::path::absolute(path).unwrap_or_else(|_| path.clone()))
            }
            procedural => procedural.clone(),
        };
        Self { wanted: Some((path, TraceHeader::new(volume, shape, display))), writer: None }
    }

    /// The rays of a live frame are about to be cast.
    pub(super) fn begin(&mut self) -> Result<(), RenderError> {
        if let (Some((path, header)), None) = (&self.wanted, &self.writer) {
            self.writer = Some(TraceWriter::create(path, header.clone())?);
        }
        Ok(())
    }

    /// What the rays of a frame sampled.
    pub(super) fn add(
        &mut self,
        frame: &FrameState,
        sampled: impl Iterator<Item = (NodeKey, u32)>,
    ) -> Result<(), RenderError> {
        if let Some(writer) = &mut self.writer {
            writer.frame(frame, sampled)?;
        }
        Ok(())
    }

    /// Gives the trace its name.
    pub(super) fn finish(&mut self) -> Result<(), RenderError> {
        self.wanted = None;
        Ok(self.writer.take().map_or(Ok(()), TraceWriter::finish)?)
    }
}
