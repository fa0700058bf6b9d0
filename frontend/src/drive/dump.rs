//! Shown pictures as files.

use super::Sink;
use crate::FrontendError;
use protocol::ScreenImage;
use rayon::prelude::*;
use renderer::output::{OutputError, can_write_into, write_codes};
use std::path::PathBuf;
use std::time::Duration;

/// A folder with a folder for each frame, with a PNG for each projector: the codes that screens show.
pub struct Dump {
    folder: PathBuf,
}

impl Dump {
    /// Into this folder, which is made if it is not there.
    ///
    /// # Errors
    /// Nothing can be written there.
    pub fn into(folder: PathBuf) -> Result<Self, FrontendError> {
        can_write_into(&folder)?;
        Ok(Self { folder })
    }
}

impl Sink for Dump {
    fn show(
        &mut self,
        frame: u32,
        images: &[ScreenImage],
        _: Duration,
        _: Duration,
    ) -> Result<(), FrontendError> {
        let folder = self.folder.join(format!("frame-{frame:06}"));
        let failed = |source| OutputError::Write { path: folder.clone(), source };
        std::fs::create_dir_all(&folder).map_err(failed)?;
        let write = |image: &ScreenImage| {
            let path = folder.join(format!("projector-{:02}.png", image.projector));
            write_codes(&path, image.width, image.height, &image.rgb)
        };
        Ok(images.par_iter().try_for_each(write)?)
    }
}
