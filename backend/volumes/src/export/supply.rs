//! Where an export's voxels come from, until somebody asks to stop.

use super::ExportError;
use bricks::BrickSource;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// A source of bricks and what an export of it is for.
#[derive(Clone, Copy)]
pub(super) struct Supply<'a> {
    pub source: &'a dyn BrickSource,
    /// What is written, for errors.
    pub out: &'a Path,
    pub stop: Option<&'a AtomicBool>,
}

impl Supply<'_> {
    /// An error if somebody has asked to stop.
    pub fn check_stop(&self) -> Result<(), ExportError> {
        match self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            true => Err(ExportError::Interrupted { path: self.out.into() }),
            false => Ok(()),
        }
    }
}
