//! `lightloom import`.

use super::say;
use crate::FrontendError;
use crate::cli::ImportArgs;
use crate::progress::Progress;
use crate::report::units;
use crate::session::{self, ImportSummary};

/// Makes a store and tells about it.
pub(super) fn import(args: &ImportArgs) -> Result<(), FrontendError> {
    let summary = session::import(args, Progress::new(!args.quiet && !args.json))?;
    if args.json {
        say(&serde_json::to_string_pretty(&summary)?);
    } else if !args.quiet {
        say(&text(args, &summary));
    }
    Ok(())
}

fn text(args: &ImportArgs, summary: &ImportSummary) -> String {
    let (dims, (low, high)) = (summary.dims, summary.value_range);
    let mut text = format!(
        "{}: {} × {} × {} voxels from {low} to {high}; {} in, {} out in {} bricks, {}; error RMS {:.3e}, largest {:.3e}",
        args.output.display(),
        dims.x,
        dims.y,
        dims.z,
        units::bytes(summary.source_bytes),
        units::bytes(summary.store_bytes),
        units::count(summary.stored_bricks),
        units::milliseconds(summary.total_ms),
        summary.rms_error,
        summary.max_error,
    );
    if summary.non_finite > 0 {
        text += &format!(
            "; {} voxels were not finite numbers and were replaced",
            units::count(summary.non_finite)
        );
    }
    text
}
