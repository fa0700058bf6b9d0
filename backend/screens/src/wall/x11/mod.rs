//! A window on each output of an X server.
//!
//! The windows take no input and belong to no window manager, so they need neither the main thread nor a desktop: a bare X
//! server is enough.

mod edid;
mod outputs;
mod pane;
mod server;
mod surface;

pub use outputs::outputs;

use super::group::groups;
use super::pixels::Layout;
use super::waiting::{LOOK_INTERVAL, SHOWN_WITHIN};
use crate::{OutputInfo, ScreenError};
use display_config::Display;
use pane::Pane;
use protocol::{ScreenImage, Wall, WallError};
use server::Server;
use std::time::{Duration, Instant};
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::Event;
use x11rb::protocol::present::{self, ConnectionExt as _};
use x11rb::protocol::randr::{ConnectionExt as _, NotifyMask};
use x11rb::protocol::xproto::{ConnectionExt as _, Cursor, ScreenSaver, Window};
use x11rb::rust_connection::RustConnection;

/// How often the server is told that somebody looks, so that it does not blank its outputs: it does so after minutes.
const WAKE_INTERVAL: Duration = Duration::from_secs(20);

/// The windows of a back-end.
pub struct XWall {
    server: Server,
    panes: Vec<Pane>,
    /// What has happened and nobody was told.
    news: Vec<String>,
    /// Whether any output may have.
    has_moved: bool,
    woken: Instant,
}

impl XWall {
    /// Opens black windows for these projectors of a display (indices into it), which have outputs. An output that is off or
    /// not there gets its window when it is.
    ///
    /// # Errors
    /// There is no X server that can show them, or none of the outputs is there.
    pub fn open(display: &Display, projectors: &[u32]) -> Result<Self, ScreenError> {
        let (connection, root) = outputs::connect()?;
        let setup = connection.setup();
        let screen = setup.roots.iter().find(|screen| screen.root == root).cloned();
        let screen = screen.ok_or_else(|| ScreenError::NoServer("it has no screen".to_owned()))?;
        let layout = Layout::of(setup, &screen)?;
        let cursor = unseen_cursor(&connection, root)?;
        let has_present = has_present(&connection)?;
        let server = Server { connection, screen, layout, cursor, has_present };
        let panes = groups(display, projectors).into_iter().map(Pane::new).collect();
        let woken = Instant::now();
        let mut wall = Self { server, panes, news: Vec::new(), has_moved: false, woken };
        if wall.has_connectors() {
            let kinds = NotifyMask::SCREEN_CHANGE | NotifyMask::CRTC_CHANGE | NotifyMask::OUTPUT_CHANGE;
            wall.server.connection.randr_select_input(root, kinds)?;
        }
        wall.follow()?;
        if wall.panes.iter().all(|pane| !pane.is_open()) {
            let connectors = wall.panes.iter().filter_map(|pane| pane.group.connector.clone());
            let wanted: Vec<String> = connectors.collect();
            let server = format!("the X server {}", std::env::var("DISPLAY").unwrap_or_default());
            return Err(ScreenError::NoOutput { wanted: wanted.join(", "), server });
        }
        wall.sync()?;
        Ok(wall)
    }

    fn has_connectors(&self) -> bool {
        self.panes.iter().any(|pane| pane.group.connector.is_some())
    }

    /// Follows the outputs to where they are.
    fn follow(&mut self) -> Result<(), ScreenError> {
        let root = self.server.screen.root;
        let size = self.server.connection.get_geometry(root)?.reply()?;
        (self.server.screen.width_in_pixels, self.server.screen.height_in_pixels) = (size.width, size.height);
        let outputs: Vec<OutputInfo> = match self.has_connectors() {
            true => outputs::read(&self.server.connection, root)?,
            false => Vec::new(),
        };
        for pane in &mut self.panes {
            self.news.extend(pane.follow(&self.server, &outputs)?);
        }
        Ok(())
    }

    fn heed(&mut self) -> Result<(), ScreenError> {
        while let Some(event) = self.server.connection.poll_for_event()? {
            self.take(event)?;
        }
        if std::mem::take(&mut self.has_moved) {
            self.follow()?;
        }
        if self.woken.elapsed() > WAKE_INTERVAL {
            self.server.connection.force_screen_saver(ScreenSaver::RESET)?;
            self.woken = Instant::now();
        }
        Ok(self.server.connection.flush()?)
    }

    fn take(&mut self, event: Event) -> Result<(), ScreenError> {
        let Self { server, panes, news, has_moved, .. } = self;
        match event {
            Event::Expose(exposed) => {
                pane_of(panes, exposed.window).map_or(Ok(()), |pane| pane.repaint(server))?;
            }
            Event::DestroyNotify(gone) => {
                // One that this wall has closed itself is no pane's any more.
                if let Some(pane) = pane_of(panes, gone.window) {
                    news.push(pane.reopen(server)?);
                }
            }
            Event::PresentCompleteNotify(shown) => {
                pane_of(panes, shown.window).into_iter().for_each(|pane| pane.shown(shown.serial));
            }
            Event::PresentIdleNotify(done) => {
                pane_of(panes, done.window).into_iter().for_each(|pane| pane.done_with(done.pixmap));
            }
            Event::RandrNotify(_) | Event::RandrScreenChangeNotify(_) => *has_moved = true,
            _ => {}
        }
        Ok(())
    }

    /// Takes what the server says until all panes are as they should be, or it has had its time.
    fn wait_for(&mut self, is_so: impl Fn(&Pane) -> bool) -> Result<(), ScreenError> {
        let since = Instant::now();
        self.server.connection.flush()?;
        while !self.panes.iter().all(&is_so) && since.elapsed() < SHOWN_WITHIN {
            match self.server.connection.poll_for_event()? {
                Some(event) => self.take(event)?,
                None => std::thread::sleep(LOOK_INTERVAL),
            }
        }
        Ok(())
    }

    /// Waits until the server has done all that it was asked to.
    fn sync(&self) -> Result<(), ScreenError> {
        self.server.connection.get_input_focus()?.reply()?;
        Ok(())
    }
}

impl Wall for XWall {
    fn ready(&mut self, images: &[ScreenImage]) -> Result<(), WallError> {
        self.wait_for(Pane::can_be_readied)?;
        self.panes.iter_mut().try_for_each(|pane| pane.ready(&self.server, images))?;
        // Pixels take a while on their way, and the moment to show them may be near.
        Ok(self.sync()?)
    }

    fn show(&mut self) -> Result<(), WallError> {
        self.panes.iter_mut().try_for_each(|pane| pane.show(&self.server))?;
        match self.server.has_present {
            true => self.wait_for(Pane::has_shown)?,
            false => self.sync()?,
        }
        Ok(())
    }

    fn tend(&mut self) -> Result<Vec<String>, WallError> {
        self.heed()?;
        Ok(std::mem::take(&mut self.news))
    }
}

fn pane_of(panes: &mut [Pane], window: Window) -> Option<&mut Pane> {
    panes.iter_mut().find(|pane| pane.has(window))
}

/// Whether a server can show pictures between two refreshes of an output.
fn has_present(connection: &RustConnection) -> Result<bool, ScreenError> {
    let is_there = connection.extension_information(present::X11_EXTENSION_NAME)?.is_some();
    Ok(is_there && connection.present_query_version(1, 0)?.reply().is_ok())
}

/// A cursor of one pixel that is not there.
fn unseen_cursor(connection: &RustConnection, root: u32) -> Result<Cursor, ScreenError> {
    let (shape, cursor) = (connection.generate_id()?, connection.generate_id()?);
    connection.create_pixmap(1, shape, root, 1, 1)?;
    let ink = connection.generate_id()?;
    // Both the shape and its mask are cleared, so no pixel of it is drawn.
    connection.create_gc(ink, shape, &x11rb::protocol::xproto::CreateGCAux::new().foreground(0))?;
    let all = x11rb::protocol::xproto::Rectangle { x: 0, y: 0, width: 1, height: 1 };
    connection.poly_fill_rectangle(shape, ink, &[all])?;
    connection.create_cursor(cursor, shape, shape, 0, 0, 0, 0, 0, 0, 0, 0)?;
    connection.free_gc(ink)?;
    connection.free_pixmap(shape)?;
    Ok(cursor)
}
