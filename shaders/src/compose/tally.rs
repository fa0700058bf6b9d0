//! The kernel that adds up what the rays of each tile counted.

use super::constants;
use super::kernel::module;

/// The name of its entry point, which is called for each of a list of tiles.
pub const TALLY_ENTRY_POINT: &str = "tally_tiles";

/// Its WGSL.
pub fn tally_wgsl() -> String {
    [constants::wgsl().as_str(), module!("layout"), module!("listed"), module!("tally")].join("\n")
}
