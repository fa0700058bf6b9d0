//! The looks of the library, each on the same volume.

mod page;

use super::plan::remove_earlier;
use super::shot::{Darkroom, Shot};
use crate::FrontendError;
use crate::progress::Progress;
use crate::report::write_text;
use crate::scene::{LookName, Scene, Values, Verdict, VolumeFacts, choose, verdict};
use crate::simulate::{Eye, Job};
use display_config::Display;
use protocol::{DeviceInfo, Draw, FrameState};
use std::path::{Path, PathBuf};

/// The page, in the output folder.
pub const LOOKS_HTML: &str = "looks.html";

/// A look that is to be drawn.
struct Trial {
    name: LookName,
    verdict: Verdict,
    frame: FrameState,
}

/// All that a page of looks needs besides the thing that draws.
pub struct LooksPage {
    /// The display.
    pub display: Display,
    /// What people call the scene.
    name: String,
    /// The look that the volume gets if nobody asks for one.
    chosen: LookName,
    trials: Vec<Trial>,
    /// The one that sees the pictures: the observer's.
    eyes: Vec<Eye>,
    out: PathBuf,
}

impl LooksPage {
    /// The scene's first frame in every look.
    ///
    /// # Errors
    /// An observer that is not in front of the screen.
    pub fn new(
        scene: &Scene,
        values: &Values,
        facts: &VolumeFacts,
        display: Display,
        out: &Path,
    ) -> Result<Self, FrontendError> {
        let trial = |name| {
            let mut scene = scene.clone();
            scene.take_look(name, values, facts);
            let frame = scene.frame(0, &display, facts)?;
            Ok(Trial { name, verdict: verdict(name, values), frame })
        };
        let trials = LookName::ALL.into_iter().map(trial).collect::<Result<Vec<_>, FrontendError>>()?;
        let observers = trials.first().map(|trial| trial.frame.observer_in_display);
        let eyes = observers.into_iter().map(|observer| Eye::before(&display, observer));
        Ok(Self {
            name: scene.name.clone(),
            chosen: choose(values).name,
            eyes: eyes.collect::<Result<_, _>>()?,
            out: out.to_owned(),
            trials,
            display,
        })
    }

    /// Makes the output folder, tries to write in it, and takes away what an earlier page of looks left there.
    pub fn prepare_output(&self) -> Result<(), FrontendError> {
        Job::prepare_output(&self.out)?;
        remove_earlier(&self.out, LookName::ALL.map(file).into_iter().chain([LOOKS_HTML.to_owned()]))
    }

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
        let path = self.out.join(LOOKS_HTML);
        write_text(&path, &page::page(self, devices)?)?;
        Ok(path)
    }
}

/// The picture of a look, in the output folder.
fn file(name: LookName) -> String {
    format!("look-{name}.png")
}
