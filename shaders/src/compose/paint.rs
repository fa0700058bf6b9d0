//! What a GPU paints windows with.

use super::constants;
use super::kernel::module;

/// The entry point that places the three corners of what is painted.
pub const PAINT_CORNER: &str = "paint_corner";
/// The entry point for a pixel of a window.
pub const PAINT_PIXEL: &str = "paint_pixel";

/// Its WGSL.
pub fn paint_wgsl() -> String {
    [constants::wgsl().as_str(), module!("present/paint")].join("\n")
}
