//! A window that covers one output, or several side by side.

use super::head::Head;
use super::painted::Painted;
use super::pixmaps::Pixmaps;
use super::region::Region;
use super::server::Server;
use super::surface::{Place, Surface, open_window};
use crate::wall::group::Part;
use crate::wall::paint::{NativeWindow, Painter};
use crate::{Rectangle, ScreenError};
use glam::UVec2;
use std::num::NonZeroU32;
use std::sync::Arc;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::ConnectionExt as _;
use x11rb::xcb_ffi::XCBConnection;

/// What paints the windows of a wall, and how its driver reaches their server.
pub struct Studio {
    pub painter: Box<dyn Painter>,
    pub connection: Arc<XCBConnection>,
    /// The number of the screen there.
    pub screen: usize,
}

/// A window.
pub struct Pane {
    /// What it covers.
    pub region: Region,
    /// What people call that.
    pub name: String,
    pub surface: Box<dyn Surface>,
}

impl Pane {
    /// A black one over a region of these outputs.
    pub fn open(
        server: &Server,
        studio: Option<&Studio>,
        region: Region,
        heads: &[Head],
    ) -> Result<Self, ScreenError> {
        let of_region = || region.heads.iter().map(|&head| &heads[head]);
        let name = of_region().map(|head| head.group.name()).collect::<Vec<_>>().join(", ");
        let places = of_region().flat_map(|head| places(head, region.place)).collect();
        let window = open_window(server, &name, region.place)?;
        let surface: Box<dyn Surface> = match studio {
            None => Box::new(Pixmaps::new(server, window, region.place, places)?),
            Some(Studio { painter, connection, screen }) => {
                // The driver's requests are not to overtake these.
                server.sync()?;
                let size = UVec2::new(region.place.width.into(), region.place.height.into());
                let id = NonZeroU32::new(window).expect("no window has the number of none");
                let canvas = painter.canvas(NativeWindow::new(Arc::clone(connection), *screen, id), size);
                match canvas {
                    Ok(canvas) => Box::new(Painted::new(server, window, canvas, places)),
                    Err(why) => {
                        server.connection.destroy_window(window)?;
                        return Err(ScreenError::Painting(why));
                    }
                }
            }
        };
        Ok(Self { region, name, surface })
    }

    /// Closes it.
    pub fn close(self, server: &Server) -> Result<(), ScreenError> {
        let window = self.surface.window();
        self.surface.close(server)?;
        server.connection.destroy_window(window)?;
        server.connection.flush()?;
        Ok(())
    }
}

/// Where the pictures of an output lie in a window over this region.
fn places(head: &Head, region: Rectangle) -> Vec<Place> {
    let Some(Rectangle { x, y, width, height }) = head.place else { return Vec::new() };
    let size = UVec2::new(width.into(), height.into());
    let corner = UVec2::new((x - region.x).unsigned_abs().into(), (y - region.y).unsigned_abs().into());
    let place = |part: &Part| Place {
        projector: part.projector,
        first_px: corner + part.output.first_px,
        room: size.saturating_sub(part.output.first_px),
        turn: part.output.turn,
    };
    head.group.parts.iter().map(place).collect()
}
