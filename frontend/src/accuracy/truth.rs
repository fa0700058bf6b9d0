//! What pixels should be, by the reference at the scene's finest level.

use super::{AccuracyError, Study, Watch};
use bricks::LodRule;
use optics::Quality;
use protocol::{FrameState, ProjectorImage};
use rayon::prelude::*;
use reference::{Errors, Integrator, Radiance, Reference};
use serde::Serialize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// A hundredth of the RMS of the most exact settings, which f32 keeps from falling much below 1e-5.
const TOLERANCE: f64 = 1e-7;
/// What the truth may take if the user does not say how many pixels to compare.
const SECONDS: f64 = 30.0;
/// Rays by which its time is guessed.
const PROBES: usize = 256;

/// A pixel: projector, x, y.
type Pixel = (u32, u32, u32);

/// Pixels, and what they should be.
pub(super) struct Truth {
    pixels: Vec<(Pixel, Radiance)>,
    pub(super) summary: TruthSummary,
}

/// How the truth was computed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TruthSummary {
    /// Pixels compared.
    pub rays: usize,
    /// Every how many pixels along x and y.
    pub stride: u32,
    /// Whether the stride was chosen by the time it takes.
    pub is_stride_chosen: bool,
    /// Error allowed, colour and opacity from 0 to 1.
    pub tolerance: f64,
    /// Rays of which the estimated error is larger.
    pub not_reached: usize,
    /// The largest estimated error.
    pub largest_estimate: f64,
    /// Seconds it took.
    pub seconds: f64,
}

impl Truth {
    /// The truth of a study; `show` gets the part that is done, 0 to 1.
    pub(super) fn of(
        study: &Study,
        watch: &Watch,
        show: &(dyn Fn(f64) + Sync),
    ) -> Result<Self, AccuracyError> {
        let tracer = Tracer::new(study)?;
        let stride = match study.stride {
            Some(stride) => stride,
            None => tracer.affordable_stride(watch)?,
        };
        let pixels = pixels(study, stride);
        if pixels.is_empty() {
            return Err(AccuracyError::Stride(stride));
        }
        let started = Instant::now();
        let pixels = tracer.trace(pixels, watch, show)?;
        let estimates = pixels.iter().map(|(_, radiance)| radiance.error_estimate);
        let summary = TruthSummary {
            rays: pixels.len(),
            stride,
            is_stride_chosen: study.stride.is_none(),
            tolerance: TOLERANCE,
            not_reached: pixels.iter().filter(|(_, radiance)| !radiance.reached).count(),
            largest_estimate: estimates.fold(0.0, f64::max),
            seconds: started.elapsed().as_secs_f64(),
        };
        let truth = Self { pixels, summary };
        truth.check_light(study)?;
        Ok(truth)
    }

    /// Pictures against the truth; they must be of all projectors of the study.
    pub(super) fn errors(&self, images: &[ProjectorImage]) -> Option<Errors> {
        let found = |(projector, x, y): Pixel| {
            let image = images.iter().find(|image| image.projector == projector)?;
            let at = 4 * (y as usize * image.width as usize + x as usize);
            let rgba: [f32; 4] = image.rgba.get(at..at + 4)?.try_into().ok()?;
            Some(rgba.map(f64::from))
        };
        let pairs = self.pixels.iter().map(|&(pixel, radiance)| {
            let [r, g, b] = radiance.rgb.to_array();
            (found(pixel).unwrap_or([f64::NAN; 4]), [r, g, b, radiance.opacity])
        });
        Errors::of(pairs)
    }

    /// A black picture would make every setting perfect.
    fn check_light(&self, study: &Study) -> Result<(), AccuracyError> {
        if self.pixels.iter().any(|(_, radiance)| radiance.opacity > 0.0) {
            return Ok(());
        }
        Err(AccuracyError::Black { rays: self.pixels.len(), projectors: study.projectors.clone() })
    }
}

/// Every `stride`-th pixel of the projectors, from half a stride on.
fn pixels(study: &Study, stride: u32) -> Vec<Pixel> {
    let along = |n: u32| (stride / 2..n).step_by(stride as usize);
    let of = |&projector: &u32| {
        let raster = &study.display.projectors[projector as usize].raster;
        along(raster.height).flat_map(move |y| along(raster.width).map(move |x| (projector, x, y)))
    };
    study.projectors.iter().flat_map(of).collect()
}

/// The reference with all that makes a ray of a pixel.
struct Tracer<'a> {
    study: &'a Study,
    reference: Reference,
}

impl<'a> Tracer<'a> {
    fn new(study: &'a Study) -> Result<Self, AccuracyError> {
        let finest = Quality { lod_scale: 0.0, ..study.frame.quality };
        let frame = FrameState { quality: finest, ..study.frame.clone() };
        let rule = LodRule::new(&study.display, frame.display_from_volume, frame.quality.lod_scale);
        let integrator = Integrator { tolerance: TOLERANCE, ..Integrator::default() };
        let reference = Reference::new(study.source.clone(), &frame, &rule, integrator)
            .map_err(|error| AccuracyError::Backend(error.to_string()))?;
        Ok(Self { study, reference })
    }

    fn radiance(&self, (projector, x, y): Pixel) -> Result<Radiance, AccuracyError> {
        let Study { display, frame, .. } = self.study;
        let failed = |sentence: String| AccuracyError::Backend(sentence);
        let law = display
            .beam_law(projector as usize, frame.observer_in_display, frame.eta)
            .map_err(|error| failed(error.to_string()))?;
        let ray = law.ray(display.pixel_on_screen(projector as usize, x, y));
        let radiance = self.reference.radiance(ray.origin_in_display, ray.direction_in_display);
        radiance.map_err(|error| failed(error.to_string()))
    }

    fn trace(
        &self,
        pixels: Vec<Pixel>,
        watch: &Watch,
        show: &(dyn Fn(f64) + Sync),
    ) -> Result<Vec<(Pixel, Radiance)>, AccuracyError> {
        let (done, total) = (AtomicUsize::new(0), pixels.len());
        let one = |pixel| {
            watch.check()?;
            let radiance = self.radiance(pixel)?;
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if done.is_multiple_of(64) {
                show(done as f64 / total as f64);
            }
            Ok((pixel, radiance))
        };
        pixels.into_par_iter().map(one).collect()
    }

    /// The stride at which the truth takes about [`SECONDS`], by the time of a few rays from all over the pictures. These
    /// read the bricks, too, so the guess is on the long side.
    fn affordable_stride(&self, watch: &Watch) -> Result<u32, AccuracyError> {
        let all = pixels(self.study, 1);
        // Odd, so that the probes do not stand in columns.
        let every = (all.len() / PROBES) | 1;
        let probes: Vec<Pixel> = all.iter().copied().step_by(every).collect();
        let (count, started) = (probes.len(), Instant::now());
        self.trace(probes, watch, &|_| {})?;
        let seconds = started.elapsed().as_secs_f64() / count as f64 * all.len() as f64;
        Ok(stride_within(seconds, SECONDS))
    }
}

/// The stride that leaves so little of what takes `seconds` that it takes about `most`.
fn stride_within(seconds: f64, most: f64) -> u32 {
    (seconds / most).sqrt().ceil().max(1.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stride_of_two_leaves_a_quarter() {
        let strides = [0.0, 30.0, 31.0, 120.0, 3000.0].map(|seconds| stride_within(seconds, 30.0));
        assert_eq!(strides, [1, 1, 2, 2, 10]);
    }
}
