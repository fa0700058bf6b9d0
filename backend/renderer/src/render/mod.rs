//! The renderer of one back-end. A frame is begun, gone on with and presented; whoever draws it may leave off between any
//! two tiles, and begin another in its place.
//!
//! Every frame is a course of rounds: cast some rays, learn what they found too coarse, step the working set. A live
//! frame is one round that shows what there is. A complete frame is rounds without fades and without a limit of uploads,
//! view by view, until nothing is missing.

mod account;
mod ancestors;
mod complete;
mod damage;
#[cfg(test)]
mod damage_tests;
mod error;
mod feedback;
#[cfg(test)]
mod interrupt_tests;
mod live;
#[cfg(test)]
mod mirror_tests;
mod recording;
#[cfg(test)]
mod recording_tests;
mod renderer;
mod report;
mod rules;
mod setting;
mod shelf;
#[cfg(test)]
mod short_tests;
mod stock;
#[cfg(test)]
mod test_scene;
mod views;
mod work;

<<<<<<< engine
pub use error::RenderError;
pub use renderer::Renderer;
=======
use crate::device::{ChosenDevice, Device, DeviceError, open_device};
use crate::working_set::{Loader, PANTRY_BYTES};
use bricks::{BrickError, BrickSource, NodeKey};
use display_config::Display;
use live::Live;
use optics::Enhancer;
use protocol::{DeviceInfo, Draw, FrameReport, FrameState, Pace, RenderEvent, Setup};
use recording::Recording;
use residency::Residency;
use std::sync::Arc;

/// Why a frame could not be drawn.
#[derive(Clone, Debug, thiserror::Error)]
pub enum RenderError {
    /// The root's brick could not be had: any other is drawn from its parent.
    #[error(transparent)]
    Brick(#[from] BrickError),
    /// The device failed.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The frame cannot be drawn on this display.
    #[error("projector {projector}: {why}")]
    Ray {
        /// Name of the projector.
        projector: String,
        /// What is wrong with its rays.
        why: String,
    },
    /// The optical model is no optical model.
    #[error(transparent)]
    Optics(#[from] optics::OpticsError),
    /// The light is no light.
    #[error("the light's {0}")]
    Light(optics::OutOfBounds),
    /// The quality is no quality.
    #[error("the quality's {0}")]
    Quality(optics::OutOfBounds),
    /// The frame's clock is no clock.
    #[error("the frame's {what} is {seconds} s; give a finite number{}", if *.what == "fade" { " of at least 0" } else { "" })]
    Clock {
        /// `time` or `fade`.
        what: &'static str,
        /// What it is.
        seconds: f64,
    },
    /// The trace cannot be written; the sentence is the trace's.
    #[error("{0}")]
    Trace(String),
}

/// The renderer of one back-end.
pub struct Renderer {
    display: Display,
    projectors: Vec<u32>,
    backend: u32,
    device: Device,
    residency: Residency,
    live: Option<Live>,
    recording: Recording,
}

impl Renderer {
    /// Opens the device; the volume is already open.
    ///
    /// # Errors
    /// The device cannot be had.
    pub fn new(setup: &Setup, source: Arc<dyn BrickSource>) -> Result<(Self, DeviceInfo), RenderError> {
        let shape = source.shape();
        let bricks: u64 =
            (0..=shape.finest_depth()).map(|d| shape.level_bricks(d).as_u64vec3().element_product()).sum();
        let ChosenDevice { device, info } =
            open_device(setup.device, setup.filter, setup.cache_bytes, bricks)?;
        let loader = Loader::new(Arc::clone(&source), loader_threads(), PANTRY_BYTES);
        let residency = Residency::new(source, loader, device.slots());
        let renderer = Self {
            display: setup.display.clone(),
            projectors: setup.projectors.clone(),
            backend: setup.backend,
            device,
            residency,
            live: None,
            recording: Recording::new(setup, &shape),
        };
        Ok((renderer, info))
    }

    /// Draws one frame, picture by picture: until nothing is missing, or with what there is, as its pace says.
    ///
    /// # Errors
    /// The root's brick or the device fails, or the frame does not fit the display.
    pub fn draw(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<FrameReport, RenderError> {
        frame.optics.check()?;
        frame.light.map_or(Ok(()), |light| light.check()).map_err(RenderError::Light)?;
        frame.quality.check().map_err(RenderError::Quality)?;
        check_clock(frame)?;
        let in_reach = self.in_reach(frame);
        let frame = in_reach.as_ref().unwrap_or(frame);
        match frame.pace {
            Pace::Complete => {
                self.live = None;
                frame::draw(self, frame, sink)
            }
            Pace::Live { upload_bytes, fade_s } => {
                let fade_s = if frame.quality.blended { fade_s } else { 0.0 };
                live::draw(self, frame, live::Limits { upload_bytes, fade_s }, sink)
            }
        }
    }

    /// The frame without enhancers that the volume is out of reach of; None where there are none such. So tools cost
    /// nothing while nobody holds them to the volume.
    fn in_reach(&self, frame: &FrameState) -> Option<FrameState> {
        let corners = self.residency.shape().corners(NodeKey::ROOT);
        let corners = corners.map(|corner| frame.display_from_volume.transform_point3(corner));
        let acts = |enhancer: &Enhancer| enhancer.may_act_within(&corners);
        if frame.optics.enhancers.iter().all(acts) {
            return None;
        }
        let mut frame = frame.clone();
        frame.optics.enhancers.retain(acts);
        Some(frame)
    }

    /// No frame follows: completes the trace, where one is wanted.
    ///
    /// # Errors
    /// The device fails, or the trace cannot be written.
    pub fn finish(&mut self) -> Result<(), RenderError> {
        if let Some(mut live) = self.live.take() {
            live.take_last_feedback(self)?;
        }
        self.recording.finish()
    }
}

impl Draw for Renderer {
    fn draw(&mut self, frame: &FrameState, sink: &mut dyn FnMut(RenderEvent)) -> Result<FrameReport, String> {
        Self::draw(self, frame, sink).map_err(|error| error.to_string())
    }

    fn finish(&mut self) -> Result<(), String> {
        Self::finish(self).map_err(|error| error.to_string())
    }
}

/// Enough to keep a disk busy while others unpack.
fn loader_threads() -> usize {
    std::thread::available_parallelism().map_or(2, |n| n.get().clamp(2, 8))
}

fn check_clock(frame: &FrameState) -> Result<(), RenderError> {
    let wrong = |what, seconds| Err(RenderError::Clock { what, seconds });
    match frame.pace {
        _ if !frame.time_s.is_finite() => wrong("time", frame.time_s),
        Pace::Live { fade_s, .. } if !(fade_s >= 0.0 && fade_s.is_finite()) => wrong("fade", fade_s),
        _ => Ok(()),
    }
}
>>>>>>> FETCH_HEAD
