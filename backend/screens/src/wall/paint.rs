//! Windows that a GPU paints.

use crate::ScreenError;
use glam::UVec2;
use protocol::{Canvas, Wall};
use std::ffi::{c_int, c_void};
use std::num::NonZeroU32;
use std::ptr::NonNull;
use std::sync::Arc;
use winit::raw_window_handle::{
    DisplayHandle, HandleError, HasDisplayHandle, HasWindowHandle, WindowHandle, XcbDisplayHandle,
    XcbWindowHandle,
};
use x11rb::xcb_ffi::XCBConnection;

/// What makes canvases of windows.
pub trait Painter: Send {
    /// The longest edge of a window that it paints, pixels.
    fn longest_edge(&self) -> u32;

    /// One for all of a window of so many pixels.
    ///
    /// # Errors
    /// It does not paint this one: a sentence.
    fn canvas(&self, window: NativeWindow, size: UVec2) -> Result<Box<dyn Canvas>, String>;
}

/// A wall on outputs.
pub trait OutputWall: Wall {
    /// Has its windows painted from now on.
    ///
    /// # Errors
    /// They cannot be. Then pictures come from main memory as before, unless the window system is gone.
    fn paint_by(&mut self, painter: Box<dyn Painter>) -> Result<(), ScreenError>;
}

/// A window as drivers know it.
#[derive(Clone)]
pub struct NativeWindow {
    /// One of its own: drivers speak to the server by a library of theirs.
    connection: Arc<XCBConnection>,
    screen: c_int,
    window: NonZeroU32,
}

impl NativeWindow {
    /// A window on a screen of the server that this connects to. It has to be there already.
    pub(super) fn new(connection: Arc<XCBConnection>, screen: usize, window: NonZeroU32) -> Self {
        Self { connection, screen: screen as c_int, window }
    }
}

impl HasDisplayHandle for NativeWindow {
    fn display_handle(&self) -> Result<DisplayHandle<'_>, HandleError> {
        let connection: *mut c_void = self.connection.get_raw_xcb_connection();
        let raw = XcbDisplayHandle::new(NonNull::new(connection), self.screen);
        // SAFETY: the connection is open as long as this is borrowed, because it is shared with it.
        Ok(unsafe { DisplayHandle::borrow_raw(raw.into()) })
    }
}

impl HasWindowHandle for NativeWindow {
    fn window_handle(&self) -> Result<WindowHandle<'_>, HandleError> {
        // SAFETY: the handle is a number, which the server looks up; one of no window leads to an error and nothing worse.
        Ok(unsafe { WindowHandle::borrow_raw(XcbWindowHandle::new(self.window).into()) })
    }
}
