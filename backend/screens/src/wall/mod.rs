//! A window on each output that a back-end's projectors are wired to.
//!
//! The windows take no input, so they need neither the main thread nor, on X, a desktop: a bare server is enough.

mod group;
mod paint;
mod pixels;
mod waiting;
mod wayland;
mod x11;

use crate::{OutputInfo, ScreenError};
use display_config::Display;
pub use paint::{NativeWindow, OutputWall, Painter};

use wayland::WaylandWall;
use x11::XWall;

/// The outputs of the Wayland desktop that WAYLAND_DISPLAY names, or else of the X server that DISPLAY names.
///
/// # Errors
/// There is none, or it cannot tell.
pub fn outputs() -> Result<Vec<OutputInfo>, ScreenError> {
    if wayland::is_there() { wayland::outputs() } else { x11::outputs() }
}

/// Opens black windows there for these projectors of a display (indices into it), which have outputs. An output that is off or
/// not there gets its window when it is.
///
/// # Errors
/// There is nothing that can show them, or none of the outputs is there.
pub fn open_wall(display: &Display, projectors: &[u32]) -> Result<Box<dyn OutputWall>, ScreenError> {
    match wayland::is_there() {
        true => Ok(Box::new(WaylandWall::open(display, projectors)?)),
        false => Ok(Box::new(XWall::open(display, projectors)?)),
    }
}
