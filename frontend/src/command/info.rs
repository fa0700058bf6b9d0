//! `lightloom info`.

use super::say::say;
use super::table::level_table;
use crate::FrontendError;
use crate::adapter::{self, StoreSummary};
use crate::cli::InfoArgs;
use crate::report::units;
use transport::launch::printable;

/// Prints what a store holds.
pub(super) fn info(args: &InfoArgs) -> Result<(), FrontendError> {
    let summary = adapter::store_summary(&args.store)?;
    if args.json {
        say(&serde_json::to_string_pretty(&summary)?)?;
    } else {
        say(&text(&summary))?;
    }
    Ok(())
}

fn text(store: &StoreSummary) -> String {
    let (dims, size_mm, (low, high)) = (store.dims, store.frame.voxel_size_m * 1e3, store.value_range);
    let deviation = if store.has_deviation { "kept" } else { "not kept" };
    let rows = [
        ("made from", printable(&store.source)),
        ("format version", store.format_version.to_string()),
        ("voxels", format!("{} × {} × {}", dims.x, dims.y, dims.z)),
        ("voxel size", format!("{:.4} × {:.4} × {:.4} mm", size_mm.x, size_mm.y, size_mm.z)),
        ("patient axes", store.frame.orientation.clone()),
        ("modality", store.modality.clone()),
        ("values", format!("{low} to {high}")),
        ("codes", format!("{} bits, codec {}", store.bits, store.codec)),
        ("octree", format!("{} nodes on {} levels", units::count(store.nodes), store.levels)),
        ("bricks with bytes", units::count(store.stored_bricks)),
        ("file", format!("{}, {:.3} bits per voxel", units::bytes(store.bytes), store.bits_per_voxel)),
        ("standard deviation", deviation.to_owned()),
    ];
    let row = |(name, value): &(&str, String)| format!("{name:<20}{value}\n");
    let facts: String = rows.iter().map(row).collect();
    format!("{facts}{}", level_table(&store.level_errors)).trim_end().to_owned()
}
