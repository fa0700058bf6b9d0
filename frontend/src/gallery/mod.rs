//! A gallery: each illustrative technique off and on, as eyes in front of a display see it.

mod curves;
mod page;
mod shot;
mod subject;
mod technique;
#[cfg(test)]
mod tests;

pub use shot::{Exhibit, Shot};
pub use subject::Subject;
pub use technique::{TECHNIQUES, Technique};

use crate::FrontendError;
use crate::progress::Progress;
use crate::report::write_text;
use crate::simulate::{Eye, FrameSource, Job};
use display_config::{Display, Homography};
use glam::{DMat3, DVec3, UVec2};
use protocol::DeviceInfo;
use renderer::output::OutputError;
use std::path::{Path, PathBuf};

/// The page, in the output folder.
pub const HTML: &str = "gallery.html";
/// What the eyes are called, from left to right.
pub const EYES: [&str; 3] = ["left", "middle", "right"];

/// All that a gallery needs besides the thing that draws.
pub struct Gallery {
    /// What people call the scene.
    pub name: String,
    /// What techniques are shown on.
    pub subject: Subject,
    /// The display.
    pub display: Display,
    /// The eyes, from left to right.
    pub eyes: Vec<Eye>,
    /// The output folder.
    pub out: PathBuf,
}

impl Gallery {
    /// The gallery of a subject, whose eyes it takes.
    pub fn new(name: &str, subject: Subject, display: Display, out: &Path) -> Result<Self, FrontendError> {
        let eyes = subject.eyes.iter().map(|&eye| Eye::before(&display, eye)).collect::<Result<_, _>>()?;
        Ok(Self { name: name.to_owned(), subject, display, eyes, out: out.to_owned() })
    }

    /// Makes the output folder, tries to write in it, and takes away the page of an earlier gallery: it would describe
    /// other pictures.
    pub fn prepare_output(&self) -> Result<(), FrontendError> {
        Job::prepare_output(&self.out)?;
        let path = self.out.join(HTML);
        match std::fs::remove_file(&path) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                Err(OutputError::Write { path, source }.into())
            }
            _ => Ok(()),
        }
    }

    /// Draws every technique off and on. Equal frames are drawn once.
    pub fn draw(
        &self,
        source: &mut dyn FrameSource,
        progress: &mut Progress,
    ) -> Result<Vec<Exhibit>, FrontendError> {
        let mut darkroom = shot::Darkroom::new(self);
        let mut exhibits = Vec::with_capacity(TECHNIQUES.len());
        for (place, technique) in TECHNIQUES.iter().enumerate() {
            progress.set(place as f64 / TECHNIQUES.len() as f64, technique.name);
            let off = (technique.off)(&self.subject);
            let mut on = off.clone();
            (technique.turn_on)(&self.subject, &mut on);
            exhibits.push(Exhibit {
                technique,
                off: darkroom.shot(source, off, &format!("{}-off", slug(technique.name)))?,
                on: darkroom.shot(source, on, &format!("{}-on", slug(technique.name)))?,
            });
        }
        Ok(exhibits)
    }

    /// Writes the page, which holds its pictures.
    pub fn write_page(&self, exhibits: &[Exhibit], devices: &[DeviceInfo]) -> Result<PathBuf, FrontendError> {
        let path = self.out.join(HTML);
        write_text(&path, &page::page(self, exhibits, devices)?)?;
        Ok(path)
    }
}

/// A name as part of a file's name.
fn slug(name: &str) -> String {
    name.to_lowercase().replace(' ', "-").replace(',', "")
}

/// The display with projectors of so many pixels, which light the same parts of the screen.
pub fn with_picture_size(mut display: Display, size: UVec2) -> Display {
    for projector in &mut display.projectors {
        let raster = &mut projector.raster;
        let old_from_new = raster.size() / size.as_dvec2();
        let pixels = DMat3::from_diagonal(DVec3::new(old_from_new.x, old_from_new.y, 1.0));
        raster.screen_from_pixel = Homography(raster.screen_from_pixel.0 * pixels);
        (raster.width, raster.height) = (size.x, size.y);
    }
    display
}
