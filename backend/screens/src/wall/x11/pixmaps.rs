//! A window whose pictures come from main memory.

use super::server::Server;
use super::surface::{Place, Surface};
use crate::{Rectangle, ScreenError};
use glam::UVec2;
use protocol::{ScreenImage, ScreenPicture};
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::present::{CompleteNotifyEvent, ConnectionExt as _};
use x11rb::protocol::xproto::{
    ConnectionExt as _, CreateGCAux, Gcontext, ImageFormat, Pixmap, Rectangle as Filled, Window,
};

/// Pixels travel in pieces of this size, bytes, so that a server with several clients goes on with them in between.
const PIECE: usize = 1 << 20;

/// One is on the output, one waits for its turn, and one is made ready.
const PICTURES: usize = 3;

/// It, with the pictures that it shows and will show.
pub struct Pixmaps {
    window: Window,
    /// Where the pictures of projectors lie there.
    places: Vec<Place>,
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

impl Pixmaps {
    /// Black pictures for a window of this size.
    pub fn new(
        server: &Server,
        window: Window,
        place: Rectangle,
        places: Vec<Place>,
    ) -> Result<Self, ScreenError> {
        let Server { connection, screen, layout, .. } = server;
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
        Ok(Self { window, places, ink, pictures, front: 0, back: 1, place, serial: 0, has_shown: true })
    }

    /// The picture to make ready next: one that is not shown and that the server does not read.
    fn spare(&self) -> Option<usize> {
        (0..PICTURES).find(|&index| index != self.front && !self.pictures[index].is_read)
    }

    /// Begins to make a picture ready; of what is shown now, where parts of it stay. Where the server still reads all of
    /// them, one that it has long had the time for is overwritten.
    fn begin(&mut self, server: &Server, keeps_parts: bool) -> Result<(), ScreenError> {
        self.back = self.spare().unwrap_or((self.front + 1) % PICTURES);
        if keeps_parts {
            self.copy(server, self.pictures[self.front].pixmap, self.pictures[self.back].pixmap)?;
        }
        Ok(())
    }

    /// Puts the picture of a projector into it.
    fn put(&self, server: &Server, image: &ScreenImage, place: &Place) -> Result<(), ScreenError> {
        let Server { connection, layout, .. } = server;
        let size = place.turn.size(UVec2::new(image.width, image.height));
        let bytes = layout.bytes(image, place.turn);
        let row_bytes = 4 * size.x as usize;
        // A request is a little longer than its pixels.
        let room = connection.maximum_request_bytes().saturating_sub(64).min(PIECE);
        let rows = (room / row_bytes.max(1)).max(1);
        for (piece, pixels) in bytes.chunks(rows * row_bytes.max(1)).enumerate() {
            let y = place.first_px.y as usize + piece * rows;
            // Beyond these there is no output.
            let (Ok(x), Ok(y)) = (i16::try_from(place.first_px.x), i16::try_from(y)) else { break };
            let (width, height) = (size.x as u16, (pixels.len() / row_bytes) as u16);
            let (into, format) = (self.pictures[self.back].pixmap, ImageFormat::Z_PIXMAP);
            connection.put_image(format, into, self.ink, width, height, x, y, 0, layout.depth, pixels)?;
        }
        Ok(())
    }

    fn copy(&self, server: &Server, from: u32, to: u32) -> Result<(), ScreenError> {
        let Rectangle { width, height, .. } = self.place;
        server.connection.copy_area(from, to, self.ink, 0, 0, 0, 0, width, height)?;
        Ok(())
    }
}

impl Surface for Pixmaps {
    fn window(&self) -> Window {
        self.window
    }

    fn can_be_readied(&self) -> bool {
        self.spare().is_some()
    }

    fn ready(&mut self, server: &Server, pictures: &[ScreenPicture]) -> Result<(), ScreenError> {
        let image_of = |place: &Place| {
            let mut images = pictures.iter().filter_map(ScreenPicture::on_host);
            images.find(|image| image.projector == place.projector)
        };
        self.begin(server, self.places.iter().any(|place| image_of(place).is_none()))?;
        for place in &self.places {
            if let Some(image) = image_of(place) {
                self.put(server, image, place)?;
            }
        }
        Ok(())
    }

    fn show(&mut self, server: &Server) -> Result<(), ScreenError> {
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

    fn has_shown(&self) -> bool {
        self.has_shown
    }

    fn completed(&mut self, event: &CompleteNotifyEvent) {
        self.has_shown |= event.serial == self.serial;
    }

    fn done_with(&mut self, pixmap: Pixmap) {
        self.pictures
            .iter_mut()
            .filter(|picture| picture.pixmap == pixmap)
            .for_each(|picture| picture.is_read = false);
    }

    fn repaint(&mut self, server: &Server) -> Result<(), ScreenError> {
        self.copy(server, self.pictures[self.front].pixmap, self.window)
    }

    fn close(self: Box<Self>, server: &Server) -> Result<(), ScreenError> {
        for picture in &self.pictures {
            server.connection.free_pixmap(picture.pixmap)?;
        }
        server.connection.free_gc(self.ink)?;
        Ok(())
    }
}
