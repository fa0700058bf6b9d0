//! Writes a trace.

use super::record::{FORMAT, FrameLine, HeaderLine, VERSION};
use super::{Demand, TraceError, TraceHeader};
use bricks::NodeKey;
use bricks::temporary::temporary_in;
use optics::Optics;
use protocol::FrameState;
use serde::Serialize;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A trace being written, under another name until it is finished: nothing half-written ever has the final name.
#[derive(Debug)]
pub struct TraceWriter {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
    /// Those of the frame before: they rarely change.
    optics: Option<Optics>,
}

impl TraceWriter {
    /// Starts a trace that will be `path`.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn create(path: &Path, header: TraceHeader) -> Result<Self, TraceError> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let file = temporary_in(folder).map_err(|e| TraceError::write(path, e))?;
        let mut writer = Self { path: path.to_owned(), file: BufWriter::new(file), optics: None };
        writer.line(&HeaderLine { format: FORMAT.to_owned(), version: VERSION, header })?;
        Ok(writer)
    }

    /// Adds a frame: the nodes that its rays sampled, of all views in any order, with the number of rays.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn frame(
        &mut self,
        frame: &FrameState,
        sampled: impl Iterator<Item = (NodeKey, u32)>,
    ) -> Result<(), TraceError> {
        let changed = self.optics.as_ref() != Some(&frame.optics);
        let optics = changed.then(|| frame.optics.clone());
        let line = FrameLine::new(frame, optics.clone(), &Demand::new(sampled));
        self.optics = optics.or(self.optics.take());
        self.line(&line)
    }

    /// Gives the whole trace its name; what had it before is replaced. A trace that is dropped instead leaves nothing.
    ///
    /// # Errors
    /// The file cannot be written or renamed.
    pub fn finish(self) -> Result<(), TraceError> {
        let path = self.path;
        let file = self.file.into_inner().map_err(|e| TraceError::write(&path, e.into_error()))?;
        file.persist(&path).map_err(|e| TraceError::write(&path, e.error))?;
        Ok(())
    }

    fn line(&mut self, line: &impl Serialize) -> Result<(), TraceError> {
        let write = |file: &mut BufWriter<NamedTempFile>| {
            serde_json::to_writer(&mut *file, line)?;
            file.write_all(b"\n")
        };
        write(&mut self.file).map_err(|e| TraceError::write(&self.path, e))
    }
}
