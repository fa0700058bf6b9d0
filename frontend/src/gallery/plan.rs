//! What a gallery is made of.

use super::Subject;
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
}
