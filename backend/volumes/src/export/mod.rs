//! A level of a store, or a part of it, as a file for other programs: NRRD, and OME-Zarr 0.5.

mod error;
mod grid;
mod nrrd;
mod numbers;
mod options;
mod part;
mod rounding;
mod supply;
#[cfg(test)]
mod tests;
mod zarr;

pub use error::ExportError;
pub use options::{ExportOptions, ExportReport};

use bricks::BrickSource;
use part::Part;
use std::path::Path;
use std::time::Instant;
use supply::Supply;

/// Writes a `.nrrd` file or a `.zarr` folder from a store. It appears under its name only when it is complete;
/// `progress` gets (done, total) in planes. The whole volume is never in memory.
///
/// # Errors
/// A name of neither kind or of something that is there, a part that is not in the level, values that are beyond the
/// type asked for, a damaged brick, a request to stop, and what the file system says.
pub fn export(
    source: &dyn BrickSource,
    out: &Path,
    options: &ExportOptions,
    progress: &dyn Fn(u64, u64),
) -> Result<ExportReport, ExportError> {
    let started = Instant::now();
    let is_zarr = match out.extension().and_then(|extension| extension.to_str()) {
        Some("nrrd") => false,
        Some("zarr") => true,
        _ => return Err(ExportError::Name { path: out.into() }),
    };
    // A link to nowhere is there as well.
    if out.symlink_metadata().is_ok() {
        return Err(ExportError::Exists { path: out.into() });
    }
    let has_all_levels = is_zarr && (options.level, options.low, options.size) == (None, None, None);
    let parts = match has_all_levels {
        true => grid::all_levels(source),
        false => vec![grid::part(source, options)?],
    };
    if !is_zarr {
        nrrd::check_size(&parts[0])?;
    }
    let supply = Supply { source, out, stop: options.stop.as_deref() };
    let element = match options.element {
        Some(element) => element,
        None => numbers::smallest_element(supply, &parts)?,
    };
    let total: u64 = parts.iter().map(|part| u64::from(part.size.z)).sum();
    let done = std::cell::Cell::new(0);
    let wrote = |planes: u32| {
        done.set(done.get() + u64::from(planes));
        progress(done.get(), total);
    };
    let bytes = match is_zarr {
        false => nrrd::write(supply, &parts[0], element, options.is_packed, &wrote)?,
        true => zarr::write(supply, &parts, element, &wrote)?,
    };
    Ok(ExportReport {
        levels: parts.iter().map(|part| part.size).collect(),
        element,
        bytes,
        has_lost_directions: is_zarr && !grid::is_upright(&source.frame()),
        duration: started.elapsed(),
    })
}
