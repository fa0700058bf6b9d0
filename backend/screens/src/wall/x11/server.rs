//! The X server that a wall's windows are on.

use crate::ScreenError;
use crate::wall::pixels::Layout;
use x11rb::protocol::xproto::{ConnectionExt as _, Cursor, Screen};
use x11rb::rust_connection::RustConnection;

/// What all panes of a wall share.
pub struct Server {
    pub connection: RustConnection,
    pub screen: Screen,
    pub layout: Layout,
    /// One that is not to be seen.
    pub cursor: Cursor,
    /// Whether it can show a picture between two refreshes of an output (the X Present extension).
    pub has_present: bool,
}

impl Server {
    /// Waits until it has done all that it was asked to.
    pub fn sync(&self) -> Result<(), ScreenError> {
        self.connection.get_input_focus()?.reply()?;
        Ok(())
    }
}
