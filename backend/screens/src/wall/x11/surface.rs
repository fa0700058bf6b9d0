//! A window, and how pictures get into it.

use super::server::Server;
use crate::{Rectangle, ScreenError};
use display_config::Turn;
use glam::UVec2;
use protocol::ScreenPicture;
use x11rb::connection::Connection;
use x11rb::protocol::present::{CompleteNotifyEvent, ConnectionExt as _, EventMask as PresentMask};
use x11rb::protocol::xproto::{
    AtomEnum, ConfigureWindowAux, ConnectionExt as _, CreateWindowAux, EventMask, Pixmap, PropMode, Screen,
    StackMode, Window, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

/// Where the picture of a projector lies in a window.
#[derive(Clone, Debug)]
pub struct Place {
    /// The projector.
    pub projector: u32,
    /// The window's pixel at the top left of the picture.
    pub first_px: UVec2,
    /// Pixels of its output from there on.
    pub room: UVec2,
    /// How it lies there.
    pub turn: Turn,
}

/// What a window shows and will show.
pub trait Surface: Send {
    /// The window.
    fn window(&self) -> Window;

    /// Whether the server is done with a picture that another has taken the place of, so that it can take the next.
    fn can_be_readied(&self) -> bool;

    /// Puts pictures where they will be seen once it is shown.
    fn ready(&mut self, server: &Server, pictures: &[ScreenPicture]) -> Result<(), ScreenError>;

    /// Has what is ready shown: before the next refresh of the output and as a whole, where the server knows of refreshes, and
    /// at once elsewhere.
    fn show(&mut self, server: &Server) -> Result<(), ScreenError>;

    /// Whether the server has shown what it was asked to, as far as it tells.
    fn has_shown(&self) -> bool;

    /// The server has shown something.
    fn completed(&mut self, event: &CompleteNotifyEvent);

    /// The server is done with a picture.
    fn done_with(&mut self, _picture: Pixmap) {}

    /// Shows again what is shown.
    fn repaint(&mut self, server: &Server) -> Result<(), ScreenError>;

    /// Frees what it has on the server; the window itself goes after that.
    fn close(self: Box<Self>, server: &Server) -> Result<(), ScreenError>;
}

/// A black window of its own on the desktop, which no window manager touches: full screen by way of one races with it.
pub fn open_window(server: &Server, name: &str, place: Rectangle) -> Result<Window, ScreenError> {
    let Server { connection, screen, layout, cursor, .. } = server;
    let window = connection.generate_id()?;
    let Screen { root, root_visual: visual, black_pixel, .. } = *screen;
    let Rectangle { x, y, width, height } = place;
    let look = CreateWindowAux::new()
        .override_redirect(1)
        .background_pixel(black_pixel)
        .cursor(*cursor)
        .event_mask(EventMask::EXPOSURE | EventMask::STRUCTURE_NOTIFY);
    let (border, kind) = (0, WindowClass::INPUT_OUTPUT);
    connection.create_window(layout.depth, window, root, x, y, width, height, border, kind, visual, &look)?;
    let title = format!("lightloom: {name}");
    let (replace, kind) = (PropMode::REPLACE, AtomEnum::STRING);
    connection.change_property8(replace, window, AtomEnum::WM_NAME, kind, title.as_bytes())?;
    if server.has_present {
        let events = PresentMask::COMPLETE_NOTIFY | PresentMask::IDLE_NOTIFY;
        connection.present_select_input(connection.generate_id()?, window, events)?;
    }
    connection.map_window(window)?;
    connection.configure_window(window, &ConfigureWindowAux::new().stack_mode(StackMode::ABOVE))?;
    Ok(window)
}
