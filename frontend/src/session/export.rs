//! Exporting from a store.

use crate::FrontendError;
use crate::cli::ExportArgs;
use crate::progress::Progress;
use bricks::store::Store;
use glam::UVec3;
use serde::Serialize;
use std::cell::RefCell;
use volumes::export::ExportOptions;

/// What an export did.
#[derive(Clone, Debug, Serialize)]
pub struct ExportSummary {
    /// Voxels along x, y, z of each level that was written, the finest first.
    pub levels: Vec<UVec3>,
    /// The type of the numbers: `uint8`, `float32`, …
    pub element: String,
    /// Bytes that were written.
    pub bytes: u64,
    /// Whether the format could not keep the volume's directions in space.
    pub has_lost_directions: bool,
    /// Time it took, milliseconds.
    pub total_ms: f64,
}

/// Writes a level of a store, a part of one, or all levels.
pub fn export(args: &ExportArgs, progress: Progress) -> Result<ExportSummary, FrontendError> {
    let store = Store::open(&args.store).map_err(|e| FrontendError::Volume(e.to_string()))?;
    let options = ExportOptions {
        level: args.level,
        low: args.low,
        size: args.size,
        element: args.element,
        is_packed: args.compress,
    };
    let progress = RefCell::new(progress);
    let show = |done: u64, total: u64| {
        progress.borrow_mut().set(done as f64 / total.max(1) as f64, "planes");
    };
    let report = volumes::export::export(&store, &args.output, &options, &show)
        .map_err(|e| FrontendError::Volume(e.to_string()))?;
    Ok(ExportSummary {
        levels: report.levels,
        element: report.element.to_string(),
        bytes: report.bytes,
        has_lost_directions: report.has_lost_directions,
        total_ms: 1e3 * report.duration.as_secs_f64(),
    })
}
