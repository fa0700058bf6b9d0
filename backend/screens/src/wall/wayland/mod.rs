//! A window on each output of a Wayland desktop: full screen, pixel for pixel, with nothing of the desktop around it.

mod desk;
mod events;
mod globals;
mod pane;
mod screen;
mod surface;

use super::group::groups;
use super::paint::{OutputWall, Painter};
use super::waiting::{LOOK_INTERVAL, SHOWN_WITHIN};
use crate::{OutputInfo, ScreenError};
use desk::Desk;
use display_config::Display;
use pane::Pane;
use protocol::{ScreenPicture, Wall, WallError};
use std::time::{Duration, Instant};
use wayland_client::backend::WaylandError;
use wayland_client::globals::registry_queue_init;
use wayland_client::{Connection, EventQueue};

/// How long the desktop may take to open a window.
const OPENS_WITHIN: Duration = Duration::from_secs(5);

/// The windows of a back-end.
pub struct WaylandWall {
    events: EventQueue<Desk>,
    desk: Desk,
}

/// Whether the environment names a Wayland desktop.
pub fn is_there() -> bool {
    let names_something = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    names_something("WAYLAND_DISPLAY") || names_something("WAYLAND_SOCKET")
}

/// The outputs of that desktop.
///
/// # Errors
/// It cannot be reached, or does not name them.
pub fn outputs() -> Result<Vec<OutputInfo>, ScreenError> {
    let (_, desk) = connect(Vec::new())?;
    Ok(desk.outputs())
}

/// A connection, once all outputs are told.
fn connect(panes: Vec<Pane>) -> Result<(EventQueue<Desk>, Desk), ScreenError> {
    let failed = |error: String| ScreenError::NoDesktop(error);
    let connection = Connection::connect_to_env().map_err(|error| failed(error.to_string()))?;
    let (globals, mut events) =
        registry_queue_init::<Desk>(&connection).map_err(|error| failed(error.to_string()))?;
    let mut desk = Desk::new(&globals, &events.handle(), panes)?;
    // What is bound tells of itself, and a seat then of its pointer.
    for _ in 0..2 {
        events.roundtrip(&mut desk)?;
    }
    desk.check()?;
    Ok((events, desk))
}

impl WaylandWall {
    /// Opens black windows for these projectors of a display (indices into it), which have outputs. An output that is not there
    /// gets its window when it is.
    ///
    /// # Errors
    /// There is no desktop that can show them, or none of the outputs is there.
    pub fn open(display: &Display, projectors: &[u32]) -> Result<Self, ScreenError> {
        let groups = groups(display, projectors);
        if let Some(group) = groups.iter().find(|group| group.connector.is_none()) {
            return Err(ScreenError::NoPlace(group.parts[0].name.clone()));
        }
        let wanted: Vec<String> = groups.iter().filter_map(|group| group.connector.clone()).collect();
        let (events, desk) = connect(groups.into_iter().map(Pane::new).collect())?;
        let mut wall = Self { events, desk };
        wall.desk.follow()?;
        if wall.desk.panes.iter().all(|pane| pane.open.is_none()) {
            return Err(ScreenError::NoOutput {
                wanted: wanted.join(", "),
                server: "this Wayland desktop".to_owned(),
            });
        }
        wall.wait_for(OPENS_WITHIN, Pane::is_on_screen)?;
        Ok(wall)
    }

    /// Takes what the desktop has said, and says what waits to be said.
    fn heed(&mut self) -> Result<(), ScreenError> {
        self.events.dispatch_pending(&mut self.desk)?;
        self.events.flush()?;
        if let Some(guard) = self.events.prepare_read() {
            match guard.read() {
                Err(WaylandError::Io(error)) if error.kind() == std::io::ErrorKind::WouldBlock => {}
                read => drop(read?),
            }
        }
        self.events.dispatch_pending(&mut self.desk)?;
        self.desk.take_failure()?;
        self.desk.follow()
    }

    /// Takes what the desktop says until all panes are as they should be, or it has had its time.
    fn wait_for(&mut self, time: Duration, is_so: impl Fn(&Pane) -> bool) -> Result<(), ScreenError> {
        let since = Instant::now();
        self.heed()?;
        while !self.desk.panes.iter().all(&is_so) && since.elapsed() < time {
            std::thread::sleep(LOOK_INTERVAL);
            self.heed()?;
        }
        Ok(())
    }
}

impl Wall for WaylandWall {
    fn ready(&mut self, pictures: &[ScreenPicture]) -> Result<(), WallError> {
        self.wait_for(SHOWN_WITHIN, Pane::can_be_readied)?;
        self.desk.panes.iter_mut().try_for_each(|pane| pane.ready(pictures))?;
        Ok(())
    }

    fn show(&mut self) -> Result<(), WallError> {
        let Desk { globals, panes, .. } = &mut self.desk;
        panes.iter_mut().for_each(|pane| pane.show(globals));
        Ok(self.wait_for(SHOWN_WITHIN, Pane::has_shown)?)
    }

    fn tend(&mut self) -> Result<Vec<String>, WallError> {
        self.heed()?;
        Ok(std::mem::take(&mut self.desk.news))
    }
}

impl OutputWall for WaylandWall {
    fn paint_by(&mut self, _: Box<dyn Painter>) -> Result<(), ScreenError> {
        Err(ScreenError::Painting("on Wayland windows get their pictures from main memory".to_owned()))
    }
}
