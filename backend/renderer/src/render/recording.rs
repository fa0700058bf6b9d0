//! The trace of what rays of live frames asked for, if one is wanted.

use super::RenderError;
use crate::working_set::{TraceHeader, TraceWriter};
use bricks::{NodeKey, OctreeShape};
use display_config::Display;
use protocol::{FrameState, VolumeRef};
use std::path::PathBuf;

/// It begins with the first live frame and gets its name at the end, also where a run is stopped.
#[derive(Debug, Default)]
pub(super) struct Recording {
    /// Where, and of what; None if no trace is wanted.
    wanted: Option<(PathBuf, TraceHeader)>,
    writer: Option<TraceWriter>,
    /// Whether the trace tells of any frame.
    has_frames: bool,
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
        Self { wanted: Some((path, TraceHeader::new(volume, shape, display))), ..Self::default() }
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
            self.has_frames = true;
        }
        Ok(())
    }

    /// Gives the trace its name. One that tells of no frame takes no other's place.
    pub(super) fn finish(&mut self) -> Result<(), RenderError> {
        self.wanted = None;
        let writer = self.writer.take().filter(|_| self.has_frames);
        Ok(writer.map_or(Ok(()), TraceWriter::finish)?)
    }
}
