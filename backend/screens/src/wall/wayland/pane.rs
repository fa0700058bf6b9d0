//! A window that covers an output, with the pictures of the projectors there.

use super::globals::{Globals, Hears};
use super::screen::Screen;
use super::surface::Surface;
use crate::wall::group::Group;
use crate::{OutputInfo, ScreenError};
use protocol::ScreenPicture;

/// The window of an output.
pub struct Pane {
    group: Group,
    /// None while there is no such output.
    pub open: Option<Surface>,
    /// Whether anybody was told that there is none.
    is_missed: bool,
    /// Whether somebody has closed it.
    pub is_closed: bool,
    /// Whether something may have come before it.
    pub is_hidden: bool,
}

impl Pane {
    /// That of some projectors, which has no window yet.
    pub fn new(group: Group) -> Self {
        Self { group, open: None, is_missed: false, is_closed: false, is_hidden: false }
    }

    /// Opens its window, the `index`th, on its output as that is now, or closes it. What has changed, in sentences.
    pub fn follow(
        &mut self,
        index: usize,
        globals: &Globals<impl Hears>,
        screens: &[Screen],
        outputs: &[OutputInfo],
    ) -> Result<Vec<String>, ScreenError> {
        let screen = screens.iter().find(|screen| screen.name == self.group.connector);
        let wanted = screen.and_then(|screen| Some((screen, screen.size()?)));
        let place = wanted.map(|(screen, size)| (screen.global, size));
        let before = self.open.as_ref().map(|open| (open.screen, open.size));
        let name = self.group.name();
        let mut said = Vec::new();
        let (was_closed, was_hidden) =
            (std::mem::take(&mut self.is_closed), std::mem::take(&mut self.is_hidden));
        let is_same = place == before && (place.is_some() || self.is_missed);
        if is_same && !(before.is_some() && (was_closed || was_hidden)) {
            return Ok(Vec::new());
        }
        if was_closed && is_same {
            said.push(format!("somebody closed the window on {name}; it is open again"));
        }
        let closed = self.open.take();
        let Some((screen, size)) = wanted else {
            self.is_missed = true;
            return Ok(vec![self.group.absence(outputs)]);
        };
        let mut open = Surface::new(index, globals, screen, size, &name)?;
        let [width, height] = size;
        if let Some(closed) = closed {
            open.take_over(&closed);
        }
        self.open = Some(open);
        if (before.is_some() && place != before) || std::mem::take(&mut self.is_missed) {
            said.push(format!("{name} now shows {width} × {height} pixels"));
        }
        if place != before {
            said.extend(self.group.cuts(width.into(), height.into()));
        }
        Ok(said)
    }

    /// Whether its window is open, where it has one.
    pub fn is_on_screen(&self) -> bool {
        self.open.as_ref().is_none_or(Surface::is_on_screen)
    }

    /// Whether the desktop is done with a picture, so that it can take the next.
    pub fn can_be_readied(&self) -> bool {
        self.open.as_ref().is_none_or(|open| open.spare().is_some())
    }

    /// Puts pictures where they will be seen once it is shown.
    pub fn ready(&mut self, pictures: &[ScreenPicture]) -> Result<(), ScreenError> {
        let Some(open) = &mut self.open else { return Ok(()) };
        for image in pictures.iter().filter_map(ScreenPicture::on_host) {
            let part = self.group.parts.iter().find(|part| part.projector == image.projector);
            part.into_iter().for_each(|part| open.put(image, &part.output));
        }
        open.ready()
    }

    /// Has what is ready shown.
    pub fn show(&mut self, globals: &Globals<impl Hears>) {
        self.open.iter_mut().for_each(|open| open.show(globals));
    }

    /// Whether the desktop has shown what it was asked to.
    pub fn has_shown(&self) -> bool {
        self.open.as_ref().is_none_or(|open| open.has_shown)
    }
}
