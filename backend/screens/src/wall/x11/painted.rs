//! A window that a GPU paints.

use super::server::Server;
use super::surface::{Place, Surface};
use crate::ScreenError;
use protocol::{Canvas, DeviceCodes, PaintedPart, ScreenPicture, WallError};
use x11rb::protocol::present::{CompleteKind, CompleteNotifyEvent};
use x11rb::protocol::xproto::Window;

/// After so many times that it was waited for in vain, the server is not waited for any more: a driver has no more pictures on
/// their way than that.
const UNTOLD: u32 = 3;

/// It, with the newest pictures.
pub struct Painted {
    window: Window,
    canvas: Box<dyn Canvas>,
    /// Each with its newest codes, once there are any.
    parts: Vec<(Place, Option<DeviceCodes>)>,
    /// Whether the server tells when it has shown something, as far as is known. Drivers may go past it.
    tells: bool,
    /// Whether it has ever told.
    has_told: bool,
    /// Times that something was shown.
    asked: u32,
    /// Of those, the server has told so many.
    told: u32,
}

impl Painted {
    /// A black window, which is there already.
    pub fn new(server: &Server, window: Window, canvas: Box<dyn Canvas>, places: Vec<Place>) -> Self {
        let parts = places.into_iter().map(|place| (place, None)).collect();
        Self { window, canvas, parts, tells: server.has_present, has_told: false, asked: 0, told: 0 }
    }

    fn paint(&mut self) -> Result<(), ScreenError> {
        let part = |(place, newest): &(Place, Option<DeviceCodes>)| {
            let &Place { first_px, room, turn, .. } = place;
            Some(PaintedPart { codes: newest.clone()?, first_px, room, turn })
        };
        let parts: Vec<PaintedPart> = self.parts.iter().filter_map(part).collect();
        self.canvas.ready(&parts).map_err(|WallError(why)| ScreenError::Painting(why))
    }
}

impl Surface for Painted {
    fn window(&self) -> Window {
        self.window
    }

    fn can_be_readied(&self) -> bool {
        // The driver waits for it.
        true
    }

    fn ready(&mut self, _: &Server, pictures: &[ScreenPicture]) -> Result<(), ScreenError> {
        for codes in pictures.iter().filter_map(ScreenPicture::on_device) {
            let part = self.parts.iter_mut().find(|(place, _)| place.projector == codes.projector);
            part.into_iter().for_each(|(_, newest)| *newest = Some(codes.clone()));
        }
        self.paint()
    }

    fn show(&mut self, _: &Server) -> Result<(), ScreenError> {
        self.tells &= self.has_told || self.asked < UNTOLD;
        self.told = self.asked;
        self.asked += u32::from(self.canvas.show());
        Ok(())
    }

    fn has_shown(&self) -> bool {
        !self.tells || self.told == self.asked
    }

    fn completed(&mut self, event: &CompleteNotifyEvent) {
        if event.kind == CompleteKind::PIXMAP {
            self.has_told = true;
            self.told = self.asked.min(self.told + 1);
        }
    }

    fn repaint(&mut self, server: &Server) -> Result<(), ScreenError> {
        // One that somebody has closed meanwhile cannot be painted, and is closed to this wall soon as well.
        if self.paint().is_ok() { self.show(server) } else { Ok(()) }
    }

    fn close(self: Box<Self>, _: &Server) -> Result<(), ScreenError> {
        // The driver frees what it has.
        Ok(())
    }
}
