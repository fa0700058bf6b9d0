//! Keys for a window without a window manager: on a bare X server nobody else gives a window the keyboard.

use winit::raw_window_handle::{HasWindowHandle, RawWindowHandle};
use winit::window::Window;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt, InputFocus};

/// Gives a window of X the keyboard, where no window manager does. It is not worth a failure.
pub(crate) fn take(window: &Window) {
    let id = match window.window_handle().map(|handle| handle.as_raw()) {
        Ok(RawWindowHandle::Xlib(handle)) => u32::try_from(handle.window).ok(),
        Ok(RawWindowHandle::Xcb(handle)) => Some(handle.window.get()),
        _ => None,
    };
    let _ = id.map(take_on_x);
}

fn take_on_x(window: u32) -> Result<(), Box<dyn std::error::Error>> {
    let (connection, screen) = x11rb::connect(None)?;
    let root = connection.setup().roots[screen].root;
    let manager = connection.intern_atom(true, b"_NET_SUPPORTING_WM_CHECK")?.reply()?.atom;
    let told = connection.get_property(false, root, manager, AtomEnum::ANY, 0, 1);
    // An atom that nobody has made is no property of anything.
    let is_managed = manager != 0 && told?.reply()?.value_len > 0;
    if !is_managed {
        connection.set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME)?.check()?;
    }
    Ok(())
}
