//! A window that covers an output, with the pictures of the projectors there.

use super::server::Server;
use super::surface::Surface;
use crate::wall::group::{Group, Part};
use crate::{OutputInfo, Rectangle, ScreenError};
use protocol::ScreenImage;
use x11rb::protocol::xproto::{ConnectionExt as _, Pixmap, Screen, Window};

/// The window of an output, or of the whole desktop.
pub struct Pane {
    /// Whose pictures it shows, and where.
    pub group: Group,
    /// None while there is no such output.
    open: Option<Surface>,
    /// Whether anybody was told that there is none.
    is_missed: bool,
}

impl Pane {
    /// That of some projectors, which has no window yet.
    pub fn new(group: Group) -> Self {
        Self { group, open: None, is_missed: false }
    }

    /// Whether it has a window.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Whether this is its window.
    pub fn has(&self, window: Window) -> bool {
        self.open.as_ref().is_some_and(|open| open.window() == window)
    }

    /// Goes where its output is now: opens its window, moves it or closes it. What has changed, in sentences.
    pub fn follow(&mut self, server: &Server, outputs: &[OutputInfo]) -> Result<Vec<String>, ScreenError> {
        let place = self.place(server, outputs);
        let before = self.open.as_ref().map(Surface::place);
        if place == before && (place.is_some() || self.is_missed) {
            return Ok(Vec::new());
        }
        self.close(server)?;
        let Some(place) = place else {
            self.is_missed = true;
            return Ok(vec![self.group.absence(outputs)]);
        };
        self.open = Some(Surface::new(server, &self.group.name(), place)?);
        let Rectangle { width, height, x, y } = place;
        let mut said = Vec::new();
        if before.is_some() || std::mem::take(&mut self.is_missed) {
            said.push(format!("{} now shows {width} × {height} pixels from {x}, {y}", self.group.name()));
        }
        said.extend(self.group.cuts(width.into(), height.into()));
        Ok(said)
    }

    /// Where its output is on the desktop; None where it is off.
    fn place(&self, server: &Server, outputs: &[OutputInfo]) -> Option<Rectangle> {
        let Some(connector) = &self.group.connector else {
            let Screen { width_in_pixels: width, height_in_pixels: height, .. } = server.screen;
            return Some(Rectangle { x: 0, y: 0, width, height });
        };
        let output = outputs.iter().find(|output| output.connector == *connector)?;
        output.shows.map(|(place, _)| place)
    }

    /// Its window was closed by somebody: opens it again.
    pub fn reopen(&mut self, server: &Server) -> Result<String, ScreenError> {
        if let Some(open) = self.open.take() {
            open.forget(server)?;
            self.open = Some(Surface::new(server, &self.group.name(), open.place())?);
        }
        Ok(format!("somebody closed the window on {}; it is open again", self.group.name()))
    }

    /// Whether the server is done with a picture that another has taken the place of, so that it can take the next.
    pub fn can_be_readied(&self) -> bool {
        self.open.as_ref().is_none_or(|open| open.spare().is_some())
    }

    /// Puts pictures where they will be seen once it is shown.
    pub fn ready(&mut self, server: &Server, images: &[ScreenImage]) -> Result<(), ScreenError> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let image_of = |part: &Part| images.iter().find(|image| image.projector == part.projector);
        open.begin(server, self.group.parts.iter().any(|part| image_of(part).is_none()))?;
        for part in &self.group.parts {
            if let Some(image) = image_of(part) {
                open.put(server, image, &part.output)?;
            }
        }
        Ok(())
    }

    /// Has what is ready shown.
    pub fn show(&mut self, server: &Server) -> Result<(), ScreenError> {
        self.open.as_mut().map_or(Ok(()), |open| open.show(server))
    }

    /// Whether the server has shown what it was asked to.
    pub fn has_shown(&self) -> bool {
        self.open.as_ref().is_none_or(Surface::has_shown)
    }

    /// The server has shown what this serial number was given to.
    pub fn shown(&mut self, serial: u32) {
        self.open.iter_mut().for_each(|open| open.shown(serial));
    }

    /// The server is done with a picture.
    pub fn done_with(&mut self, picture: Pixmap) {
        self.open.iter_mut().for_each(|open| open.done_with(picture));
    }

    /// Shows again what is shown.
    pub fn repaint(&self, server: &Server) -> Result<(), ScreenError> {
        self.open.as_ref().map_or(Ok(()), |open| open.repaint(server))
    }

    fn close(&mut self, server: &Server) -> Result<(), ScreenError> {
        let Some(open) = self.open.take() else { return Ok(()) };
        server.connection.destroy_window(open.window())?;
        open.forget(server)
    }
}
