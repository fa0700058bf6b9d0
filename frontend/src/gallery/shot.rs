//! The pictures of one frame as the eyes see it.

use super::plan::files;
use super::{Gallery, Technique};
use crate::FrontendError;
use crate::report::Totals;
use crate::simulate::EyeViews;
use protocol::{Draw, FrameState, RenderEvent};
use renderer::output::{OutputError, write_png};
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
    gallery: &'a Gallery,
    drawn: Vec<(FrameState, Shot)>,
}

impl<'a> Darkroom<'a> {
    pub fn new(gallery: &'a Gallery) -> Self {
        Self { gallery, drawn: Vec::new() }
    }

    /// The pictures of a frame; new ones are written to files whose names begin so.
    pub fn shot(
        &mut self,
        source: &mut dyn Draw,
        frame: FrameState,
        name: &str,
    ) -> Result<Shot, FrontendError> {
        if let Some((_, shot)) = self.drawn.iter().find(|(drawn, _)| *drawn == frame) {
            return Ok(shot.clone());
        }
        let shot = self.draw(source, &frame, name)?;
        self.drawn.push((frame, shot.clone()));
        Ok(shot)
    }

    fn draw(&self, source: &mut dyn Draw, frame: &FrameState, name: &str) -> Result<Shot, FrontendError> {
        let started = Instant::now();
        let views = EyeViews::new(&self.gallery.display, &self.gallery.eyes);
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
        let files = files(name);
        for (picture, file) in views.finish(frame.index)?.iter().zip(&files) {
            write_png(&self.gallery.out.join(file), picture.view()?)?;
        }
        Ok(Shot { files: files.into(), wall, total: Totals::of(&reports) })
    }
}
