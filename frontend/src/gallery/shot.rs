//! The pictures of one frame as the eyes see it.

use super::Technique;
use crate::FrontendError;
use crate::report::Totals;
use crate::simulate::{Eye, EyeViews};
use display_config::Display;
use protocol::{Draw, FrameState, RenderEvent};
use renderer::output::{OutputError, write_png};
use std::path::Path;
use std::time::{Duration, Instant};

/// A technique with its pictures.
pub struct Exhibit {
    /// The technique.
    pub technique: &'static Technique,
    /// Without it.
    pub off: Shot,
    /// With it.
    pub on: Shot,
}

/// A frame that has been drawn.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Pictures in the output folder, one per eye, from left to right.
    pub files: Vec<String>,
    /// How long all projectors took, bricks loaded on the way included.
    pub wall: Duration,
    /// The back-ends' accounts, added up.
    pub total: Totals,
}

impl Shot {
    /// Samples per ray, on average.
    pub fn samples_per_ray(&self) -> f64 {
        self.total.samples as f64 / self.total.rays.max(1) as f64
    }
}

/// Draws frames, and remembers those that it has drawn.
pub(super) struct Darkroom<'a> {
    display: &'a Display,
    eyes: &'a [Eye],
    out: &'a Path,
    drawn: Vec<(FrameState, Shot)>,
}

impl<'a> Darkroom<'a> {
    pub fn new(display: &'a Display, eyes: &'a [Eye], out: &'a Path) -> Self {
        Self { display, eyes, out, drawn: Vec::new() }
    }

    /// The pictures of a frame; new ones are written to these files, one per eye.
    pub fn shot(
        &mut self,
        source: &mut dyn Draw,
        frame: FrameState,
        files: &[String],
    ) -> Result<Shot, FrontendError> {
        if let Some((_, shot)) = self.drawn.iter().find(|(drawn, _)| *drawn == frame) {
            return Ok(shot.clone());
        }
        let shot = self.draw(source, &frame, files)?;
        self.drawn.push((frame, shot.clone()));
        Ok(shot)
    }

    fn draw(
        &self,
        source: &mut dyn Draw,
        frame: &FrameState,
        files: &[String],
    ) -> Result<Shot, FrontendError> {
        let started = Instant::now();
        let views = EyeViews::new(self.display, self.eyes);
        let mut failure: Option<OutputError> = None;
        let reports = source.draw(frame, &mut |event| {
            if let RenderEvent::Image(image) = event
                && let Err(error) = views.add(&image)
            {
                failure.get_or_insert(error);
            }
        })?;
        failure.map_or(Ok(()), Err)?;
        let wall = started.elapsed();
        for (picture, file) in views.finish(frame.index)?.iter().zip(files) {
            write_png(&self.out.join(file), picture.view()?)?;
        }
        Ok(Shot { files: files.to_vec(), wall, total: Totals::of(&reports) })
    }
}
