//! `lightloom export`.

use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter::{self, ExportSummary};
use crate::cli::ExportArgs;
use crate::progress::Progress;
use crate::report::units;

/// Writes voxels of a store for other programs, and reports on it.
pub(super) fn export(args: &ExportArgs) -> Result<(), FrontendError> {
    let summary = adapter::export(
        &args.store,
        &args.output,
        &args.options(),
        Progress::new(!args.quiet && !args.json),
    )?;
    if args.json {
        say(&serde_json::to_string_pretty(&summary)?)?;
        return Ok(());
    }
    if !args.quiet {
        if summary.has_lost_directions {
            warn("OME-Zarr cannot store directions, so the axes are the volume's own; NRRD stores them");
        }
        say(&text(args, &summary))?;
    }
    Ok(())
}

fn text(args: &ExportArgs, summary: &ExportSummary) -> String {
    let levels = summary.levels.iter().map(|n| format!("{} × {} × {}", n.x, n.y, n.z));
    format!(
        "{}: {} voxels of {}, {}, {}",
        args.output.display(),
        levels.collect::<Vec<_>>().join(", "),
        summary.element,
        units::bytes(summary.bytes),
        units::milliseconds(summary.total_ms),
    )
}
