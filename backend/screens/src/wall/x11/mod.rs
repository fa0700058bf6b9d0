//! A window on each output of an X server.
//!
//! The windows take no input and belong to no window manager, so they need neither the main thread nor a desktop: a bare X
//! server is enough.

mod edid;
mod head;
mod outputs;
mod painted;
mod pane;
mod pixmaps;
mod region;
mod server;
mod surface;

pub use outputs::outputs;

use super::group::groups;
use super::paint::{OutputWall, Painter};
use super::pixels::Layout;
use super::waiting::{LOOK_INTERVAL, SHOWN_WITHIN};
use crate::{OutputInfo, Rectangle, ScreenError};
use display_config::Display;
use head::Head;
use pane::{Pane, Studio};
use protocol::{ScreenPicture, Wall, WallError};
use region::{Region, join};
use server::Server;
use std::sync::Arc;
use std::time::{Duration, Instant};
use surface::Surface;
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::Event;
use x11rb::protocol::present::{self, ConnectionExt as _};
use x11rb::protocol::randr::{ConnectionExt as _, NotifyMask};
use x11rb::protocol::xproto::{ConnectionExt as _, Cursor, ScreenSaver, Window};
use x11rb::rust_connection::RustConnection;
use x11rb::xcb_ffi::{XCBConnection, load_libxcb};

/// How often the server is told that somebody looks, so that it does not blank its outputs: it does so after minutes.
const WAKE_INTERVAL: Duration = Duration::from_secs(20);

/// The windows of a back-end.
pub struct XWall {
    /// Before the server: drivers free what they have in a window while there is one.
    panes: Vec<Pane>,
    server: Server,
    heads: Vec<Head>,
    /// What paints the windows; None where pictures come from main memory.
    studio: Option<Studio>,
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
        let heads = groups(display, projectors).into_iter().map(Head::new).collect();
        let woken = Instant::now();
        let mut wall = Self {
            panes: Vec::new(),
            server,
            heads,
            studio: None,
            news: Vec::new(),
            has_moved: false,
            woken,
        };
        if wall.has_connectors() {
            let kinds = NotifyMask::SCREEN_CHANGE | NotifyMask::CRTC_CHANGE | NotifyMask::OUTPUT_CHANGE;
            wall.server.connection.randr_select_input(root, kinds)?;
        }
        wall.follow()?;
        if wall.panes.is_empty() {
            let connectors = wall.heads.iter().filter_map(|head| head.group.connector.clone());
            let wanted: Vec<String> = connectors.collect();
            let server = format!("the X server {}", std::env::var("DISPLAY").unwrap_or_default());
            return Err(ScreenError::NoOutput { wanted: wanted.join(", "), server });
        }
        wall.server.sync()?;
        Ok(wall)
    }

    fn has_connectors(&self) -> bool {
        self.heads.iter().any(|head| head.group.connector.is_some())
    }

    /// Follows the outputs to where they are.
    fn follow(&mut self) -> Result<(), ScreenError> {
        let root = self.server.screen.root;
        let size = self.server.connection.get_geometry(root)?.reply()?;
        let desktop = Rectangle { x: 0, y: 0, width: size.width, height: size.height };
        let outputs: Vec<OutputInfo> = match self.has_connectors() {
            true => outputs::read(&self.server.connection, root)?,
            false => Vec::new(),
        };
        for head in &mut self.heads {
            self.news.extend(head.follow(desktop, &outputs));
        }
        self.arrange()
    }

    /// Opens and closes windows until there is one over each region of outputs.
    fn arrange(&mut self) -> Result<(), ScreenError> {
        let found = self.heads.iter().enumerate();
        let apart = found.filter_map(|(index, head)| Some(Region::of(index, head.place?))).collect();
        let regions = match &self.studio {
            Some(studio) => join(apart, studio.painter.longest_edge()),
            None => apart,
        };
        let (stay, go): (Vec<Pane>, Vec<Pane>) =
            self.panes.drain(..).partition(|pane| regions.contains(&pane.region));
        self.panes = stay;
        go.into_iter().try_for_each(|pane| pane.close(&self.server))?;
        for region in regions {
            if !self.panes.iter().any(|pane| pane.region == region) {
                self.panes.push(Pane::open(&self.server, self.studio.as_ref(), region, &self.heads)?);
            }
        }
        Ok(())
    }

    /// Opens all windows anew.
    fn rearrange(&mut self, studio: Option<Studio>) -> Result<(), ScreenError> {
        self.panes.drain(..).try_for_each(|pane| pane.close(&self.server))?;
        self.studio = studio;
        self.arrange()
    }

    /// Somebody has closed a window: opens it again.
    fn reopen(&mut self, window: Window) -> Result<(), ScreenError> {
        // One that this wall has closed itself is no pane's any more.
        let Some(gone) = self.panes.iter().position(|pane| pane.surface.window() == window) else {
            return Ok(());
        };
        let Pane { name, surface, .. } = self.panes.remove(gone);
        surface.close(&self.server)?;
        self.news.push(format!("somebody closed the window on {name}; it is open again"));
        self.arrange()
    }

    /// Puts pictures into all windows, out of sight.
    fn put(&mut self, pictures: &[ScreenPicture]) -> Result<(), ScreenError> {
        let Self { panes, server, .. } = self;
        panes.iter_mut().try_for_each(|pane| pane.surface.ready(server, pictures))
    }

    /// Takes what the server has said.
    fn hear(&mut self) -> Result<(), ScreenError> {
        while let Some(event) = self.server.connection.poll_for_event()? {
            self.take(event)?;
        }
        Ok(())
    }

    fn heed(&mut self) -> Result<(), ScreenError> {
        self.hear()?;
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
        match event {
            Event::Expose(exposed) => {
                if let Some(surface) = surface_of(&mut self.panes, exposed.window) {
                    surface.repaint(&self.server)?;
                }
            }
            Event::DestroyNotify(gone) => self.reopen(gone.window)?,
            Event::PresentCompleteNotify(shown) => {
                surface_of(&mut self.panes, shown.window)
                    .into_iter()
                    .for_each(|surface| surface.completed(&shown));
            }
            Event::PresentIdleNotify(done) => {
                surface_of(&mut self.panes, done.window)
                    .into_iter()
                    .for_each(|surface| surface.done_with(done.pixmap));
            }
            Event::RandrNotify(_) | Event::RandrScreenChangeNotify(_) => self.has_moved = true,
            _ => {}
        }
        Ok(())
    }

    /// Takes what the server says until all windows are as they should be, or it has had its time.
    fn wait_for(&mut self, is_so: impl Fn(&dyn Surface) -> bool) -> Result<(), ScreenError> {
        let since = Instant::now();
        self.server.connection.flush()?;
        while !self.panes.iter().all(|pane| is_so(&*pane.surface)) && since.elapsed() < SHOWN_WITHIN {
            match self.server.connection.poll_for_event()? {
                Some(event) => self.take(event)?,
                None => std::thread::sleep(LOOK_INTERVAL),
            }
        }
        Ok(())
    }
}

impl Wall for XWall {
    fn is_painted(&self) -> bool {
        self.studio.is_some()
    }

    fn ready(&mut self, pictures: &[ScreenPicture]) -> Result<(), WallError> {
        self.wait_for(|surface| surface.can_be_readied())?;
        if self.put(pictures).is_err() {
            // A driver may know before this wall that somebody has closed a window.
            self.server.sync()?;
            self.hear()?;
            self.put(pictures)?;
        }
        // Pixels take a while on their way, and the moment to show them may be near.
        Ok(self.server.sync()?)
    }

    fn show(&mut self) -> Result<(), WallError> {
        let Self { panes, server, .. } = self;
        panes.iter_mut().try_for_each(|pane| pane.surface.show(server))?;
        match server.has_present {
            true => self.wait_for(|surface| surface.has_shown())?,
            false => server.sync()?,
        }
        Ok(())
    }

    fn tend(&mut self) -> Result<Vec<String>, WallError> {
        self.heed()?;
        Ok(std::mem::take(&mut self.news))
    }
}

impl OutputWall for XWall {
    fn paint_by(&mut self, painter: Box<dyn Painter>) -> Result<(), ScreenError> {
        load_libxcb().map_err(|error| ScreenError::Painting(format!("libxcb cannot be loaded: {error}")))?;
        let connected = XCBConnection::connect(None);
        let (connection, screen) = connected.map_err(|error| ScreenError::NoServer(error.to_string()))?;
        let studio = Studio { painter, connection: Arc::new(connection), screen };
        let painted = self.rearrange(Some(studio));
        if painted.is_err() {
            self.rearrange(None)?;
        }
        painted
    }
}

fn surface_of(panes: &mut [Pane], window: Window) -> Option<&mut dyn Surface> {
    let pane = panes.iter_mut().find(|pane| pane.surface.window() == window)?;
    Some(&mut *pane.surface)
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
