//! The pictures of one frame as the eyes see it.

use super::{EYES, Gallery, Technique};
use crate::FrontendError;
use crate::report::Totals;
use crate::simulate::{Event, EyeViews, FrameSource};
use protocol::FrameState;
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
        source: &mut dyn FrameSource,
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

    fn draw(
        &self,
        source: &mut dyn FrameSource,
        frame: &FrameState,
        name: &str,
    ) -> Result<Shot, FrontendError> {
        let started = Instant::now();
        let views = EyeViews::new(&self.gallery.display, &self.gallery.eyes);
        let mut failure: Option<OutputError> = None;
        let reports = source.render(frame, &mut |event| {
            if let Event::Image(image) = event
                && let Err(error) = views.add(&image)
            {
                failure.get_or_insert(error);
            }
        })?;
        failure.map_or(Ok(()), Err)?;
        let wall = started.elapsed();
        let mut files = Vec::with_capacity(EYES.len());
        for (picture, eye) in views.finish(frame.index)?.iter().zip(EYES) {
            let file = format!("{name}-{eye}.png");
            write_png(&self.gallery.out.join(&file), picture.view()?)?;
            files.push(file);
        }
        Ok(Shot { files, wall, total: Totals::of(&reports) })
    }
}
