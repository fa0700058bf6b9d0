//! A gallery: each illustrative technique off and on, as eyes in front of a display see it.

mod curves;
mod looks;
mod page;
mod plan;
mod shot;
mod subject;
mod technique;
#[cfg(test)]
mod tests;

pub use looks::LooksPage;
pub use plan::{EYES, Gallery, HTML};
pub use shot::{Exhibit, Shot};
pub use subject::Subject;
pub use technique::{TECHNIQUES, Technique};

use crate::FrontendError;
use crate::progress::Progress;
use crate::report::write_text;
use display_config::{Display, Homography};
use glam::{DMat3, DVec3, UVec2};
use plan::files;
use protocol::{DeviceInfo, Draw};
use std::path::PathBuf;

impl Gallery {
    /// Draws every technique off and on. Equal frames are drawn once.
    pub fn draw(
        &self,
        source: &mut dyn Draw,
        progress: &mut Progress,
    ) -> Result<Vec<Exhibit>, FrontendError> {
        let mut darkroom = shot::Darkroom::new(&self.display, &self.eyes, &self.out);
        let mut exhibits = Vec::with_capacity(TECHNIQUES.len());
        for (place, technique) in TECHNIQUES.iter().enumerate() {
            progress.set(place as f64 / TECHNIQUES.len() as f64, technique.name);
            let off = (technique.off)(&self.subject);
            let mut on = off.clone();
            (technique.turn_on)(&self.subject, &mut on);
            let [off_name, on_name] = technique.shots();
            exhibits.push(Exhibit {
                technique,
                off: darkroom.shot(source, off, &files(&off_name))?,
                on: darkroom.shot(source, on, &files(&on_name))?,
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
