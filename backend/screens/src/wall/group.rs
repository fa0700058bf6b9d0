//! The projectors that share an output.

use crate::OutputInfo;
use display_config::{Display, Output};
use glam::UVec2;

/// A projector of an output.
#[derive(Clone, Debug)]
pub struct Part {
    pub projector: u32,
    pub name: String,
    pub picture: UVec2,
    pub output: Output,
}

/// Those of one output, or of the whole desktop.
#[derive(Clone, Debug)]
pub struct Group {
    /// None is the whole desktop.
    pub connector: Option<String>,
    pub parts: Vec<Part>,
}

/// A group for each connector, in the order of the projectors (indices into a display's).
pub fn groups(display: &Display, projectors: &[u32]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for &index in projectors {
        let projector = &display.projectors[index as usize];
        let Some(output) = projector.raster.output.clone() else { continue };
        let (name, picture) = (projector.name.clone(), projector.raster.pixels());
        let part = Part { projector: index, name, picture, output };
        match groups.iter_mut().find(|group| group.connector == part.output.connector) {
            Some(group) => group.parts.push(part),
            None => groups.push(Group { connector: part.output.connector.clone(), parts: vec![part] }),
        }
    }
    groups
}

impl Group {
    /// What people call its output.
    pub fn name(&self) -> String {
        self.connector.as_ref().map_or_else(|| "the desktop".to_owned(), |name| format!("output {name}"))
    }

    /// Why there is no window on it.
    pub fn absence(&self, outputs: &[OutputInfo]) -> String {
        let names: Vec<&str> = self.parts.iter().map(|part| part.name.as_str()).collect();
        let output = outputs.iter().find(|output| Some(&output.connector) == self.connector.as_ref());
        let why = match output {
            None => "does not exist: check its name with `lightloom outputs`",
            Some(output) if !output.is_connected => "has nothing connected to it: check the cable",
            Some(_) => "is off: switch it on, for instance with xrandr",
        };
        format!("{} {why}; until then {} shows nothing", self.name(), names.join(", "))
    }

    /// Sentences on pictures that do not fit an output of so many pixels.
    pub fn cuts(&self, width: u32, height: u32) -> impl Iterator<Item = String> {
        self.parts.iter().filter_map(move |part| {
            let (first, size) = (part.output.first_px, part.output.turn.size(part.picture));
            let end = first + size;
            let fits = end.x <= width && end.y <= height;
            (!fits).then(|| {
                format!(
                    "{} has {width} × {height} pixels, and the picture of {} takes {} × {} from {}, {}: it loses an edge",
                    self.name(),
                    part.name,
                    size.x,
                    size.y,
                    first.x,
                    first.y
                )
            })
        })
    }
}
