//! Exporting from a store.

use crate::FrontendError;
use crate::interrupt;
use crate::progress::Progress;
use bricks::store::Store;
use glam::UVec3;
use serde::Serialize;
use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
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

/// Writes a level of a store, a part of one, or all levels. A signal to end stops it in good order.
pub fn export(
    store: &Path,
    output: &Path,
    options: &ExportOptions,
    progress: Progress,
) -> Result<ExportSummary, FrontendError> {
    let stop = interrupt::stop_flag()?;
    let options = ExportOptions { stop: Some(Arc::clone(&stop)), ..options.clone() };
    let failed = |sentence: String| match stop.load(Ordering::SeqCst) {
        true => FrontendError::Stopped(sentence),
        false => FrontendError::Volume(sentence),
    };
    let store = Store::open(store).map_err(|error| failed(error.to_string()))?;
    let progress = RefCell::new(progress);
    let show = |done: u64, total: u64| {
        progress.borrow_mut().set(done as f64 / total.max(1) as f64, "planes");
    };
    let report = volumes::export::export(&store, output, &options, &show)
        .map_err(|error| failed(error.to_string()))?;
    Ok(ExportSummary {
        levels: report.levels,
        element: report.element.to_string(),
        bytes: report.bytes,
        has_lost_directions: report.has_lost_directions,
        total_ms: 1e3 * report.duration.as_secs_f64(),
    })
}
