//! A window, with the pictures that it shows and will show.

use super::server::Server;
use crate::{Rectangle, ScreenError};
use display_config::Output;
use glam::UVec2;
use protocol::ScreenImage;
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::present::{ConnectionExt as _, EventMask as PresentMask};
use x11rb::protocol::xproto::{
    AtomEnum, ConfigureWindowAux, ConnectionExt as _, CreateGCAux, CreateWindowAux, EventMask, Gcontext,
    ImageFormat, Pixmap, PropMode, Rectangle as Filled, Screen, StackMode, Window, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

/// Pixels travel in pieces of this size, bytes, so that a server with several clients goes on with them in between.
const PIECE: usize = 1 << 20;

/// One is on the output, one waits for its turn, and one is made ready.
const PICTURES: usize = 3;

/// A window on the desktop.
pub struct Surface {
    window: Window,
    ink: Gcontext,
    pictures: [Picture; PICTURES],
    /// Which of them is shown, or was given to be.
    front: usize,
    /// Which is made ready.
    back: usize,
    place: Rectangle,
    /// Of what was given to be shown last.
    serial: u32,
    has_shown: bool,
}

/// A picture in the server's memory.
struct Picture {
    pixmap: Pixmap,
    /// Whether the server may still read it, for an output.
    is_read: bool,
}

impl Surface {
    /// A black window of its own on the desktop, which no window manager touches: full screen by way of one races with it.
    pub fn new(server: &Server, name: &str, place: Rectangle) -> Result<Self, ScreenError> {
        let Server { connection, screen, layout, .. } = server;
        let window = open_window(server, place)?;
        let title = format!("lightloom: {name}");
        let (replace, kind) = (PropMode::REPLACE, AtomEnum::STRING);
        connection.change_property8(replace, window, AtomEnum::WM_NAME, kind, title.as_bytes())?;
        let ink = connection.generate_id()?;
        let black = CreateGCAux::new().foreground(screen.black_pixel).graphics_exposures(0);
        connection.create_gc(ink, window, &black)?;
        let Rectangle { width, height, .. } = place;
        let picture = || -> Result<Picture, ScreenError> {
            let pixmap = connection.generate_id()?;
            connection.create_pixmap(layout.depth, pixmap, screen.root, width, height)?;
            connection.poly_fill_rectangle(pixmap, ink, &[Filled { x: 0, y: 0, width, height }])?;
            Ok(Picture { pixmap, is_read: false })
        };
        let pictures = [picture()?, picture()?, picture()?];
        if server.has_present {
            let events = PresentMask::COMPLETE_NOTIFY | PresentMask::IDLE_NOTIFY;
            connection.present_select_input(connection.generate_id()?, window, events)?;
        }
        connection.map_window(window)?;
        connection.configure_window(window, &ConfigureWindowAux::new().stack_mode(StackMode::ABOVE))?;
        Ok(Self { window, ink, pictures, front: 0, back: 1, place, serial: 0, has_shown: true })
    }

    /// The window.
    pub fn window(&self) -> Window {
        self.window
    }

    /// Where it is.
    pub fn place(&self) -> Rectangle {
        self.place
    }

    /// The picture to make ready next: one that is not shown and that the server does not read.
    pub fn spare(&self) -> Option<usize> {
        (0..PICTURES).find(|&index| index != self.front && !self.pictures[index].is_read)
    }

    /// Begins to make a picture ready; of what is shown now, where parts of it stay. Where the server still reads all of
    /// them, one that it has long had the time for is overwritten.
    pub fn begin(&mut self, server: &Server, keeps_parts: bool) -> Result<(), ScreenError> {
        self.back = self.spare().unwrap_or((self.front + 1) % PICTURES);
        if keeps_parts {
            self.copy(server, self.pictures[self.front].pixmap, self.pictures[self.back].pixmap)?;
        }
        Ok(())
    }

    /// Puts the picture of a projector into it.
    pub fn put(&self, server: &Server, image: &ScreenImage, output: &Output) -> Result<(), ScreenError> {
        let Server { connection, layout, .. } = server;
        let size = output.turn.size(UVec2::new(image.width, image.height));
        let bytes = layout.bytes(image, output.turn);
        let row_bytes = 4 * size.x as usize;
        // A request is a little longer than its pixels.
        let room = connection.maximum_request_bytes().saturating_sub(64).min(PIECE);
        let rows = (room / row_bytes.max(1)).max(1);
        for (piece, pixels) in bytes.chunks(rows * row_bytes.max(1)).enumerate() {
            let y = output.first_px.y as usize + piece * rows;
            // Beyond these there is no output.
            let (Ok(x), Ok(y)) = (i16::try_from(output.first_px.x), i16::try_from(y)) else { break };
            let (width, height) = (size.x as u16, (pixels.len() / row_bytes) as u16);
            let (into, format) = (self.pictures[self.back].pixmap, ImageFormat::Z_PIXMAP);
            connection.put_image(format, into, self.ink, width, height, x, y, 0, layout.depth, pixels)?;
        }
        Ok(())
    }

    /// Has the picture that is ready shown: before the next refresh of the output and as a whole, where the server knows of
    /// refreshes, and at once elsewhere.
    pub fn show(&mut self, server: &Server) -> Result<(), ScreenError> {
        self.front = self.back;
        let picture = &mut self.pictures[self.front];
        if !server.has_present {
            return self.repaint(server);
        }
        picture.is_read = true;
        self.serial = self.serial.wrapping_add(1);
        self.has_shown = false;
        let (whole, nobody, soon) = (x11rb::NONE, x11rb::NONE, 0);
        server.connection.present_pixmap(
            self.window,
            picture.pixmap,
            self.serial,
            whole,
            whole,
            0,
            0,
            nobody,
            nobody,
            nobody,
            0,
            soon,
            0,
            0,
            &[],
        )?;
        Ok(())
    }

    /// Whether the server has shown what it was asked to.
    pub fn has_shown(&self) -> bool {
        self.has_shown
    }

    /// The server has shown what this serial number was given to.
    pub fn shown(&mut self, serial: u32) {
        self.has_shown |= serial == self.serial;
    }

    /// The server is done with a picture.
    pub fn done_with(&mut self, pixmap: Pixmap) {
        self.pictures
            .iter_mut()
            .filter(|picture| picture.pixmap == pixmap)
            .for_each(|picture| picture.is_read = false);
    }

    /// Shows again what is shown.
    pub fn repaint(&self, server: &Server) -> Result<(), ScreenError> {
        self.copy(server, self.pictures[self.front].pixmap, self.window)
    }

    fn copy(&self, server: &Server, from: u32, to: u32) -> Result<(), ScreenError> {
        let Rectangle { width, height, .. } = self.place;
        server.connection.copy_area(from, to, self.ink, 0, 0, 0, 0, width, height)?;
        Ok(())
    }

    /// Frees what a closed window leaves behind.
    pub fn forget(&self, server: &Server) -> Result<(), ScreenError> {
        for picture in &self.pictures {
            server.connection.free_pixmap(picture.pixmap)?;
        }
        server.connection.free_gc(self.ink)?;
        Ok(())
    }
}

fn open_window(server: &Server, place: Rectangle) -> Result<Window, ScreenError> {
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
    Ok(window)
}
