//! The device that draws, setting by setting, timed.

use super::truth::Truth;
use super::{AccuracyError, Offer, Setting, Study, Trial, Watch};
use bricks::store::EightBits;
use bricks::{BrickSource, Codes, NodeKey};
use protocol::{
    DeviceInfo, FilterChoice, FrameReport, FrameState, ProjectorImage, RenderEvent, RendererOptions,
};
use reference::Errors;
use renderer::Renderer;
use serde::Serialize;
use std::sync::Arc;

/// What a setting turned out to cost and to miss.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// The setting, and why it was tried.
    #[serde(flatten)]
    pub trial: Trial,
    /// Seconds of the cast: the median of `all_seconds`.
    pub seconds: f64,
    /// Seconds of each repetition, in their order.
    pub all_seconds: Vec<f64>,
    /// Samples of the volume per ray, gradients not counted.
    pub samples_per_ray: f64,
    /// Errors of linear colour and opacity, both from 0 to 1.
    pub errors: Errors,
    /// Why pictures are not complete; empty if they are.
    pub shortfall: String,
}

/// Draws the study's frame in any setting.
pub(super) struct Bench<'a> {
    study: &'a Study,
    truth: &'a Truth,
}

impl<'a> Bench<'a> {
    pub(super) fn new(study: &'a Study, truth: &'a Truth) -> Self {
        Self { study, truth }
    }

    /// Measures settings, in their order; `show` gets how many are done. Those of one filter and one depth of samples
    /// share a renderer, which goes from coarse levels to fine ones: it never shows finer ones than it is asked for then.
    pub(super) fn measure(
        &self,
        trials: &[Trial],
        watch: &Watch,
        show: &dyn Fn(usize),
    ) -> Result<Vec<Measured>, AccuracyError> {
        let mut order: Vec<usize> = (0..trials.len()).collect();
        let device = |setting: &Setting| (setting.filter as u8, setting.bits);
        order.sort_by(|&a, &b| {
            let (a, b) = (&trials[a].setting, &trials[b].setting);
            let coarse_first = b.quality.lod_scale.total_cmp(&a.quality.lod_scale);
            device(a).cmp(&device(b)).then(coarse_first)
        });
        let mut found: Vec<Option<Measured>> = vec![None; trials.len()];
        let mut done = 0;
        for group in order.chunk_by(|&a, &b| device(&trials[a].setting) == device(&trials[b].setting)) {
            let Setting { filter, bits, .. } = trials[group[0]].setting;
            let (mut renderer, _) = open(self.study, filter, bits)?;
            for &place in group {
                found[place] = Some(self.measure_one(&mut renderer, trials[place], watch)?);
                done += 1;
                show(done);
            }
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// The first frame brings the bricks, and the pictures that are compared; those after it are timed.
    fn measure_one(
        &self,
        renderer: &mut Renderer,
        trial: Trial,
        watch: &Watch,
    ) -> Result<Measured, AccuracyError> {
        let frame = FrameState { quality: trial.setting.quality, ..self.study.frame.clone() };
        let (images, mut report) = draw(renderer, &frame)?;
        let mut all_seconds = Vec::new();
        for _ in 0..self.study.repetitions {
            watch.check()?;
            report = draw(renderer, &frame)?.1;
            all_seconds.push(1e-3 * report.stages.cast_ms);
        }
        let pixels: usize = images.iter().map(|image| image.rgba.len() / 4).sum();
        let nothing = || AccuracyError::Backend("the device drew no picture".to_owned());
        Ok(Measured {
            trial,
            seconds: median(&all_seconds),
            all_seconds,
            samples_per_ray: report.samples as f64 / pixels as f64,
            errors: self.truth.errors(&images).ok_or_else(nothing)?,
            shortfall: report.shortfall,
        })
    }
}

/// What the device and the volume offer, and the device itself.
pub(super) fn offer(study: &Study) -> Result<(Offer, DeviceInfo), AccuracyError> {
    let info = open(study, FilterChoice::Auto, AS_STORED)?.1;
    let hardware =
        || open(study, FilterChoice::Hardware, AS_STORED).is_ok_and(|(_, info)| info.filter == "hardware");
    let filters = match info.filter.as_str() {
        "hardware" => vec![FilterChoice::Hardware, FilterChoice::Exact],
        _ if hardware() => vec![FilterChoice::Exact, FilterChoice::Hardware],
        _ => vec![FilterChoice::Exact],
    };
    let root = study.source.brick(NodeKey::ROOT);
    let bits = match root.map_err(|error| AccuracyError::Backend(error.to_string()))?.codes {
        Codes::U16(_) => vec![16, 8],
        Codes::U8(_) => vec![8],
    };
    Ok((Offer { filters, bits, is_finest: study.is_finest }, info))
}

/// More bits than any store has.
const AS_STORED: u8 = 16;

fn open(study: &Study, filter: FilterChoice, bits: u8) -> Result<(Renderer, DeviceInfo), AccuracyError> {
    let options = RendererOptions {
        device: study.device,
        filter,
        cache_bytes: study.cache_bytes,
        ..RendererOptions::in_process(study.display.clone(), study.projectors.clone())
    };
    let source: Arc<dyn BrickSource> = match bits {
        8 => Arc::new(EightBits::new(Arc::clone(&study.source))),
        _ => Arc::clone(&study.source),
    };
    Renderer::new(&options, source).map_err(|error| AccuracyError::Backend(error.to_string()))
}

fn draw(
    renderer: &mut Renderer,
    frame: &FrameState,
) -> Result<(Vec<ProjectorImage>, FrameReport), AccuracyError> {
    let mut images = Vec::new();
    let mut sink = |event| match event {
        RenderEvent::Image(image) => images.push(image),
        RenderEvent::Progress { .. } => {}
    };
    let report = renderer.draw(frame, &mut sink).map_err(|e| AccuracyError::Backend(e.to_string()))?;
    Ok((images, report))
}

/// The middle one of an odd number.
fn median(seconds: &[f64]) -> f64 {
    let mut sorted = seconds.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_slow_repetition_does_not_count() {
        assert_eq!(median(&[3.0, 1.0, 99.0, 2.0, 2.5]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
