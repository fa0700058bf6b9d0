//! A window that covers an output, with the pictures of the projectors there.

use super::pixels::Layout;
use crate::{OutputInfo, Rectangle, ScreenError};
use display_config::Output;
use glam::UVec2;
use protocol::ScreenImage;
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::xproto::{
    AtomEnum, ConfigureWindowAux, ConnectionExt as _, CreateGCAux, CreateWindowAux, Cursor, EventMask,
    Gcontext, ImageFormat, Pixmap, PropMode, Rectangle as Filled, Screen, StackMode, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// Pixels travel in pieces of this size, bytes, so that a server with several clients goes on with them in between.
const PIECE: usize = 1 << 20;

/// What all panes of a wall share.
pub struct Server {
    pub connection: RustConnection,
    pub screen: Screen,
    pub layout: Layout,
    /// One that is not to be seen.
    pub cursor: Cursor,
}

/// A projector of an output.
#[derive(Clone, Debug)]
pub struct Part {
    pub projector: u32,
    pub name: String,
    pub picture: UVec2,
    pub output: Output,
}

/// The window of an output, or of the whole desktop.
pub struct Pane {
    /// None is the whole desktop.
    pub connector: Option<String>,
    parts: Vec<Part>,
    /// None while there is no such output.
    open: Option<Open>,
    /// Whether anybody was told that there is none.
    is_missed: bool,
}

/// A window with two pictures: what it shows, and what it will.
struct Open {
    window: Window,
    ink: Gcontext,
    front: Pixmap,
    back: Pixmap,
    place: Rectangle,
}

impl Pane {
    /// That of a connector, which has no window yet.
    pub fn new(connector: Option<String>, parts: Vec<Part>) -> Self {
        Self { connector, parts, open: None, is_missed: false }
    }

    /// What people call it.
    pub fn name(&self) -> String {
        self.connector.as_ref().map_or_else(|| "the desktop".to_owned(), |name| format!("output {name}"))
    }

    /// Whether it has a window.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Whether this is its window.
    pub fn has(&self, window: Window) -> bool {
        self.open.as_ref().is_some_and(|open| open.window == window)
    }

    /// Goes where its output is now: opens its window, moves it or closes it. What has changed, in sentences.
    pub fn follow(&mut self, server: &Server, outputs: &[OutputInfo]) -> Result<Vec<String>, ScreenError> {
        let place = self.place(server, outputs);
        let before = self.open.as_ref().map(|open| open.place);
        if place == before && (place.is_some() || self.is_missed) {
            return Ok(Vec::new());
        }
        self.close(server)?;
        let Some(place) = place else {
            self.is_missed = true;
            return Ok(vec![self.absence(outputs)]);
        };
        self.open = Some(Open::new(server, &self.name(), place)?);
        let Rectangle { width, height, x, y } = place;
        let mut said = Vec::new();
        if before.is_some() || std::mem::take(&mut self.is_missed) {
            said.push(format!("{} now shows {width} × {height} pixels from {x}, {y}", self.name()));
        }
        said.extend(self.parts.iter().filter_map(|part| self.cut(part, place)));
        Ok(said)
    }

    /// Where its output is on the desktop; None where it is off.
    fn place(&self, server: &Server, outputs: &[OutputInfo]) -> Option<Rectangle> {
        let Some(connector) = &self.connector else {
            let Screen { width_in_pixels: width, height_in_pixels: height, .. } = server.screen;
            return Some(Rectangle { x: 0, y: 0, width, height });
        };
        let output = outputs.iter().find(|output| output.connector == *connector)?;
        output.shows.map(|(place, _)| place)
    }

    /// Why there is no window.
    fn absence(&self, outputs: &[OutputInfo]) -> String {
        let names: Vec<&str> = self.parts.iter().map(|part| part.name.as_str()).collect();
        let output = outputs.iter().find(|output| Some(&output.connector) == self.connector.as_ref());
        let why = match output {
            None => "does not exist: check its name with `lightloom outputs`",
            Some(output) if !output.is_connected => "has nothing connected to it: check the cable",
            Some(_) => "is off: switch it on, for instance with xrandr",
        };
        format!("{} {why}; until then {} shows nothing", self.name(), names.join(", "))
    }

    /// A sentence where a picture does not fit.
    fn cut(&self, part: &Part, place: Rectangle) -> Option<String> {
        let (first, size) = (part.output.first_px, part.output.turn.size(part.picture));
        let end = first + size;
        let fits = end.x <= u32::from(place.width) && end.y <= u32::from(place.height);
        (!fits).then(|| {
            format!(
                "{} has {} × {} pixels, and the picture of {} takes {} × {} from {}, {}: it loses an edge",
                self.name(),
                place.width,
                place.height,
                part.name,
                size.x,
                size.y,
                first.x,
                first.y
            )
        })
    }

    /// Its window was closed by somebody: opens it again.
    pub fn reopen(&mut self, server: &Server) -> Result<String, ScreenError> {
        if let Some(open) = self.open.take() {
            open.forget(server)?;
            self.open = Some(Open::new(server, &self.name(), open.place)?);
        }
        Ok(format!("somebody closed the window on {}; it is open again", self.name()))
    }

    /// Puts pictures where they will be seen once it is shown.
    pub fn ready(&self, server: &Server, images: &[ScreenImage]) -> Result<(), ScreenError> {
        let Some(open) = &self.open else { return Ok(()) };
        let image_of = |part: &Part| images.iter().find(|image| image.projector == part.projector);
        if self.parts.iter().any(|part| image_of(part).is_none()) {
            open.copy(server, open.front, open.back)?;
        }
        for part in &self.parts {
            if let Some(image) = image_of(part) {
                open.put(server, image, &part.output)?;
            }
        }
        Ok(())
    }

    /// Shows what is ready.
    pub fn show(&mut self, server: &Server) -> Result<(), ScreenError> {
        let Some(open) = &mut self.open else { return Ok(()) };
        std::mem::swap(&mut open.front, &mut open.back);
        open.copy(server, open.front, open.window)
    }

    /// Shows again what is shown.
    pub fn repaint(&self, server: &Server) -> Result<(), ScreenError> {
        self.open.as_ref().map_or(Ok(()), |open| open.copy(server, open.front, open.window))
    }

    fn close(&mut self, server: &Server) -> Result<(), ScreenError> {
        let Some(open) = self.open.take() else { return Ok(()) };
        server.connection.destroy_window(open.window)?;
        open.forget(server)
    }
}

impl Open {
    /// A window of its own on the desktop, which no window manager touches: full screen by way of one races with it.
    fn new(server: &Server, name: &str, place: Rectangle) -> Result<Self, ScreenError> {
        let Server { connection, screen, layout, cursor } = server;
        let (window, ink) = (connection.generate_id()?, connection.generate_id()?);
        let Rectangle { x, y, width, height } = place;
        let look = CreateWindowAux::new()
            .override_redirect(1)
            .background_pixel(screen.black_pixel)
            .cursor(*cursor)
            .event_mask(EventMask::EXPOSURE | EventMask::STRUCTURE_NOTIFY);
        let (border, visual) = (0, screen.root_visual);
        let (kind, root) = (WindowClass::INPUT_OUTPUT, screen.root);
        connection.create_window(
            layout.depth,
            window,
            root,
            x,
            y,
            width,
            height,
            border,
            kind,
            visual,
            &look,
        )?;
        let title = format!("lightloom: {name}");
        let (replace, kind) = (PropMode::REPLACE, AtomEnum::STRING);
        connection.change_property8(replace, window, AtomEnum::WM_NAME, kind, title.as_bytes())?;
        let black = CreateGCAux::new().foreground(screen.black_pixel).graphics_exposures(0);
        connection.create_gc(ink, window, &black)?;
        let pixmap = || -> Result<Pixmap, ScreenError> {
            let pixmap = connection.generate_id()?;
            connection.create_pixmap(layout.depth, pixmap, root, width, height)?;
            connection.poly_fill_rectangle(pixmap, ink, &[Filled { x: 0, y: 0, width, height }])?;
            Ok(pixmap)
        };
        let (front, back) = (pixmap()?, pixmap()?);
        connection.map_window(window)?;
        connection.configure_window(window, &ConfigureWindowAux::new().stack_mode(StackMode::ABOVE))?;
        Ok(Self { window, ink, front, back, place })
    }

    fn copy(&self, server: &Server, from: u32, to: u32) -> Result<(), ScreenError> {
        let Rectangle { width, height, .. } = self.place;
        server.connection.copy_area(from, to, self.ink, 0, 0, 0, 0, width, height)?;
        Ok(())
    }

    fn put(&self, server: &Server, image: &ScreenImage, output: &Output) -> Result<(), ScreenError> {
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
            let format = ImageFormat::Z_PIXMAP;
            connection.put_image(
                format,
                self.back,
                self.ink,
                width,
                height,
                x,
                y,
                0,
                layout.depth,
                pixels,
            )?;
        }
        Ok(())
    }

    /// Frees what a closed window leaves behind.
    fn forget(&self, server: &Server) -> Result<(), ScreenError> {
        server.connection.free_pixmap(self.front)?;
        server.connection.free_pixmap(self.back)?;
        server.connection.free_gc(self.ink)?;
        Ok(())
    }
}
