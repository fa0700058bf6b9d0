//! The pictures of one frame on their way to files, sheets and eyes.

use super::eyes::hold;
use super::{EyeViews, Job};
use crate::FrontendError;
use display_config::Display;
use glam::DVec2;
use protocol::ProjectorImage;
use renderer::output::{ContactSheet, OutputError, PictureRef, write_codes, write_exr, write_png};
use renderer::present::Finisher;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Takes pictures from several threads, in any order, and keeps none of them.
pub(super) struct FramePictures<'a> {
    job: &'a Job,
    folder: PathBuf,
    sheet: Mutex<ContactSheet>,
    eyes: EyeViews<'a>,
    /// The first failure.
    failure: Mutex<Option<OutputError>>,
}

impl<'a> FramePictures<'a> {
    pub fn new(job: &'a Job, folder: &Path) -> Self {
        let count = job.display.projectors.len();
        Self {
            job,
            folder: folder.to_owned(),
            sheet: Mutex::new(ContactSheet::new(count as u32, shown_aspect(&job.display))),
            eyes: EyeViews::new(&job.display, &job.eyes),
            failure: Mutex::new(None),
        }
    }

    /// A projector's file; numbers have as many digits as the largest.
    pub fn projector_file(&self, projector: usize, extension: &str) -> String {
        format!("projector-{}.{extension}", self.number(projector))
    }

    fn number(&self, projector: usize) -> String {
        let digits = self.job.display.projectors.len().saturating_sub(1).to_string().len().max(2);
        format!("{projector:0digits$}")
    }

    /// An eye's file.
    pub fn eye_file(eye: usize, extension: &str) -> String {
        format!("eye-{eye}.{extension}")
    }

    /// Writes a picture and adds it to sheet and eyes; after a first failure nothing more is written.
    pub fn take(&self, image: &ProjectorImage) {
        if hold(&self.failure).is_some() {
            return;
        }
        if let Err(error) = self.try_take(image) {
            hold(&self.failure).get_or_insert(error);
        }
    }

    fn try_take(&self, image: &ProjectorImage) -> Result<(), OutputError> {
        let projector = image.projector as usize;
        let picture = PictureRef::of(image)?;
        let Some(known) = self.job.display.projectors.get(projector) else { return Ok(()) };
        self.write(picture, |extension| self.projector_file(projector, extension))?;
        if self.job.calibrated {
            let file = format!("calibrated-{}.png", self.number(projector));
            // Its tables are made for each picture: those of all projectors would take more memory than they save time.
            let codes = Finisher::new(known).codes(picture.rgba());
            write_codes(&self.folder.join(file), known.raster.width, known.raster.height, &codes)?;
        }
        hold(&self.sheet).add(image.projector, picture);
        self.eyes.add(image)
    }

    fn write(&self, picture: PictureRef<'_>, name: impl Fn(&str) -> String) -> Result<(), OutputError> {
        write_png(&self.folder.join(name("png")), picture)?;
        if self.job.exr { write_exr(&self.folder.join(name("exr")), picture) } else { Ok(()) }
    }

    /// Once all pictures have arrived: writes the eyes' views, or says what is missing.
    pub fn finish(&self, frame: u32) -> Result<(), FrontendError> {
        if let Some(error) = hold(&self.failure).take() {
            return Err(error.into());
        }
        for (index, picture) in self.eyes.finish(frame)?.iter().enumerate() {
            self.write(picture.view()?, |extension| Self::eye_file(index, extension))?;
        }
        Ok(())
    }

    /// Writes the contact sheet.
    pub fn write_sheet(&self, path: &Path) -> Result<(), OutputError> {
        write_png(path, hold(&self.sheet).view()?)
    }
}

/// Width / height of what the first projector lights on the screen: its pixels need not be square there.
fn shown_aspect(display: &Display) -> f64 {
    let Some(projector) = display.projectors.first() else { return 1.0 };
    let raster = &projector.raster;
    let (w, h) = (f64::from(raster.width), f64::from(raster.height));
    let at = |x: f64, y: f64| raster.screen_from_pixel.apply(DVec2::new(x, y));
    let (across, up) = (at(w, 0.5 * h) - at(0.0, 0.5 * h), at(0.5 * w, h) - at(0.5 * w, 0.0));
    let aspect = across.length() / up.length();
    if aspect.is_finite() { aspect.clamp(0.1, 10.0) } else { 1.0 }
}
