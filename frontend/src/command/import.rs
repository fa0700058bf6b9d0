//! `lightloom import`.

use super::say::say;
use super::table::level_table;
use crate::FrontendError;
use crate::adapter::{self, ImportSummary};
use crate::cli::ImportArgs;
use crate::progress::Progress;
use crate::report::units;

/// Makes a store and reports on it.
pub(super) fn import(args: &ImportArgs) -> Result<(), FrontendError> {
    let summary = adapter::import(&args.request(), Progress::new(!args.quiet && !args.json))?;
    if args.json {
        say(&serde_json::to_string_pretty(&summary)?)?;
    } else if !args.quiet {
        say(&text(args, &summary))?;
    }
    Ok(())
}

fn text(args: &ImportArgs, summary: &ImportSummary) -> String {
    let (dims, (low, high)) = (summary.dims, summary.value_range);
    let size_mm = summary.frame.voxel_size_m * 1e3;
    let mut text = format!(
        "{}: {} × {} × {} voxels of {:.3} × {:.3} × {:.3} mm from {low} to {high}; {} in, {} out in {} bricks, {}; error RMS {:.3e}, largest {:.3e}",
        args.output.display(),
        dims.x,
        dims.y,
        dims.z,
        size_mm.x,
        size_mm.y,
        size_mm.z,
        units::bytes(summary.source_bytes),
        units::bytes(summary.store_bytes),
        units::count(summary.stored_bricks),
        units::milliseconds(summary.total_ms),
        summary.rms_error,
        summary.max_error,
    );
    if summary.frame.is_orientation_known {
        text += &format!("; patient axes: {}", summary.frame.orientation);
    }
    if summary.emptied_bricks > 0 {
        text += &format!("; {} bricks were left out as empty", units::count(summary.emptied_bricks));
    }
    if summary.non_finite > 0 {
        text += &format!("; {} non-finite voxels were replaced", units::count(summary.non_finite));
    }
    let levels = level_table(&summary.level_errors);
    if levels.is_empty() { text } else { format!("{text}\n{}", levels.trim_end()) }
}
