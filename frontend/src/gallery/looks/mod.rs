//! The looks of the library, each on the same volume.

mod page;
mod plan;

pub use plan::LooksPage;

use super::shot::{Darkroom, Shot};
use crate::FrontendError;
use crate::progress::Progress;
use crate::report::write_text;
use crate::scene::LookName;
use plan::{HTML, file};
use protocol::{DeviceInfo, Draw};
use std::path::PathBuf;

impl LooksPage {
    /// Draws the volume in every look.
    pub fn draw(
        &self,
        source: &mut dyn Draw,
        progress: &mut Progress,
    ) -> Result<Vec<(LookName, Shot)>, FrontendError> {
        let mut darkroom = Darkroom::new(&self.display, &self.eyes, &self.out);
        let mut shots = Vec::with_capacity(self.trials.len());
        for (place, trial) in self.trials.iter().enumerate() {
            progress.set(place as f64 / self.trials.len() as f64, trial.name.text());
            let shot = darkroom.shot(source, trial.frame.clone(), &[file(trial.name)])?;
            shots.push((trial.name, shot));
        }
        Ok(shots)
    }

    /// Writes the page, which holds its pictures.
    pub fn write_page(&self, devices: &[DeviceInfo]) -> Result<PathBuf, FrontendError> {
        let path = self.out.join(HTML);
        write_text(&path, &page::page(self, devices)?)?;
        Ok(path)
    }
}
