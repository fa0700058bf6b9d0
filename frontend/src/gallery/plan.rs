//! What a gallery is made of.

use super::{Subject, TECHNIQUES};
use crate::FrontendError;
use crate::simulate::{Eye, Job};
use display_config::Display;
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

    /// Makes the output folder, tries to write in it, and takes away what an earlier gallery wrote: its page would describe
    /// other pictures, and its pictures lie among those of this one.
    pub fn prepare_output(&self) -> Result<(), FrontendError> {
        Job::prepare_output(&self.out)?;
        let pictures =
            TECHNIQUES.iter().flat_map(|technique| technique.shots()).flat_map(|shot| files(&shot));
        remove_earlier(&self.out, pictures.chain([HTML.to_owned()]))
    }
}

/// Takes files away that an earlier run may have left in the output folder.
pub(in crate::gallery) fn remove_earlier(
    out: &Path,
    names: impl IntoIterator<Item = String>,
) -> Result<(), FrontendError> {
    for name in names {
        let path = out.join(name);
        match std::fs::remove_file(&path) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                return Err(OutputError::Write { path, source }.into());
            }
            _ => {}
        }
    }
    Ok(())
}

/// The pictures of a shot, one for each eye, from left to right.
pub(super) fn files(shot: &str) -> [String; 3] {
    EYES.map(|eye| format!("{shot}-{eye}.png"))
}
