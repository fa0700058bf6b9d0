//! An output, with the projectors whose pictures it shows.

use crate::wall::group::Group;
use crate::{OutputInfo, Rectangle};

/// An output, or the whole desktop.
pub struct Head {
    /// Whose pictures it shows, and where.
    pub group: Group,
    /// Where it is on the desktop; None while there is no such output.
    pub place: Option<Rectangle>,
    /// Whether anybody was told that there is none.
    is_missed: bool,
}

impl Head {
    /// That of some projectors; nobody has looked yet where it is.
    pub fn new(group: Group) -> Self {
        Self { group, place: None, is_missed: false }
    }

    /// Follows it to where it is now, on a desktop of this size. What has changed, in sentences.
    pub fn follow(&mut self, desktop: Rectangle, outputs: &[OutputInfo]) -> Vec<String> {
        let place = self.found(desktop, outputs);
        let before = std::mem::replace(&mut self.place, place);
        if place == before && (place.is_some() || self.is_missed) {
            return Vec::new();
        }
        let Some(Rectangle { x, y, width, height }) = place else {
            self.is_missed = true;
            return vec![self.group.absence(outputs)];
        };
        let mut said = Vec::new();
        if before.is_some() || std::mem::take(&mut self.is_missed) {
            said.push(format!("{} now shows {width} × {height} pixels from {x}, {y}", self.group.name()));
        }
        said.extend(self.group.cuts(width.into(), height.into()));
        said
    }

    fn found(&self, desktop: Rectangle, outputs: &[OutputInfo]) -> Option<Rectangle> {
        let Some(connector) = &self.group.connector else { return Some(desktop) };
        let output = outputs.iter().find(|output| output.connector == *connector)?;
        output.shows.map(|(place, _)| place)
    }
}
