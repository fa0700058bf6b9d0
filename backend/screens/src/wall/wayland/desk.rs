//! A Wayland desktop: what it offers, and what a wall has there.

use super::globals::Globals;
use super::pane::Pane;
use super::screen::Screen;
use crate::{OutputInfo, ScreenError};
use wayland_client::QueueHandle;
use wayland_client::globals::GlobalList;
use wayland_client::protocol::wl_output::WlOutput;
use wayland_client::protocol::wl_registry::WlRegistry;

/// The version of outputs that have names.
pub const NAMED: u32 = 4;

/// A desktop, as far as a wall knows it.
pub struct Desk {
    pub globals: Globals<Self>,
    pub screens: Vec<Screen>,
    pub panes: Vec<Pane>,
    /// What has happened and nobody was told.
    pub news: Vec<String>,
    /// Whether any output may have changed, or a window was closed.
    pub has_moved: bool,
    /// Whether it has ever said when it showed something. Some offer to and never do.
    pub tells: bool,
    /// Why it cannot go on, where an event told.
    pub failure: Option<ScreenError>,
}

impl Desk {
    /// That of a connection, with all of its outputs.
    ///
    /// # Errors
    /// It does not offer what is needed.
    pub fn new(
        offered: &GlobalList,
        queue: &QueueHandle<Self>,
        panes: Vec<Pane>,
    ) -> Result<Self, ScreenError> {
        let globals = Globals::bind(offered, queue)?;
        let registry = offered.registry();
        let mut desk = Self {
            globals,
            screens: Vec::new(),
            panes,
            news: Vec::new(),
            has_moved: true,
            tells: false,
            failure: None,
        };
        offered.contents().with_list(|list| {
            for global in list.iter().filter(|global| global.interface == "wl_output") {
                desk.add_screen(registry, global.name, global.version);
            }
        });
        Ok(desk)
    }

    /// There is an output more.
    pub fn add_screen(&mut self, registry: &WlRegistry, global: u32, version: u32) {
        let Globals { queue, places, .. } = &self.globals;
        let output: WlOutput = registry.bind(global, version.min(NAMED), queue, global);
        places.iter().for_each(|places| drop(places.get_xdg_output(&output, queue, global)));
        self.screens.push(Screen::new(output, global));
    }

    /// An output is gone.
    pub fn remove_screen(&mut self, global: u32) {
        self.screens.retain(|screen| screen.global != global);
        self.has_moved = true;
        // The desktop moves what was there to another output, where it may hide what that shows. New windows are seen.
        self.panes.iter_mut().for_each(|pane| pane.is_hidden = true);
    }

    /// Whether outputs can be told apart.
    pub fn check(&self) -> Result<(), ScreenError> {
        match self.screens.iter().all(|screen| screen.name.is_some()) {
            true => Ok(()),
            false => Err(ScreenError::Desktop {
                what: "names for its outputs (wl_output 4), so they cannot be told apart".to_owned(),
                advice: "start this where DISPLAY names an X server, with WAYLAND_DISPLAY unset",
            }),
        }
    }

    /// What it shows, output by output.
    pub fn outputs(&self) -> Vec<OutputInfo> {
        self.screens.iter().map(Screen::info).collect()
    }

    /// Follows the outputs to what they are.
    ///
    /// # Errors
    /// There is no room for pictures.
    pub fn follow(&mut self) -> Result<(), ScreenError> {
        if !std::mem::take(&mut self.has_moved) {
            return Ok(());
        }
        let outputs = self.outputs();
        let Self { globals, screens, panes, news, .. } = self;
        for (index, pane) in panes.iter_mut().enumerate() {
            news.extend(pane.follow(index, globals, screens, &outputs)?);
        }
        Ok(())
    }

    pub fn take_failure(&mut self) -> Result<(), ScreenError> {
        self.failure.take().map_or(Ok(()), Err)
    }
}
