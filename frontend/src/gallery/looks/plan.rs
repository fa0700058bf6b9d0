//! What a page of looks is made of.

use crate::FrontendError;
use crate::gallery::plan::remove_earlier;
use crate::scene::{LookName, Scene, Values, Verdict, VolumeFacts, choose, verdict};
use crate::simulate::{Eye, Job};
use display_config::Display;
use protocol::FrameState;
use std::path::{Path, PathBuf};

/// The page, in the output folder.
pub(super) const HTML: &str = "looks.html";

/// A look that is to be drawn.
pub(super) struct Trial {
    pub name: LookName,
    pub verdict: Verdict,
    pub frame: FrameState,
}

/// All that a page of looks needs besides the thing that draws.
pub struct LooksPage {
    /// The display.
    pub display: Display,
    /// What people call the scene.
    pub(super) name: String,
    /// The look that the volume gets if nobody asks for one.
    pub(super) chosen: LookName,
    pub(super) trials: Vec<Trial>,
    /// The one that sees the pictures: the observer's.
    pub(super) eyes: Vec<Eye>,
    pub(super) out: PathBuf,
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
        remove_earlier(&self.out, LookName::ALL.map(file).into_iter().chain([HTML.to_owned()]))
    }
}

/// The picture of a look, in the output folder.
pub(super) fn file(name: LookName) -> String {
    format!("look-{name}.png")
}
