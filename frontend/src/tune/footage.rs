//! The complete pictures of a scenario, of the projectors that an eye sees.

use super::{RATE_HZ, Scenario};
use crate::FrontendError;
use bricks::BrickSource;
use display_config::{Display, EyeModel};
use glam::DVec3;
use protocol::{CasterChoice, DeviceChoice, FrameState, ProjectorImage, RenderEvent, RendererOptions};
use renderer::Renderer;
use renderer::output::Picture;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The pictures of one instant.
pub type Pictures = Arc<Vec<ProjectorImage>>;

/// The footage of a scenario.
pub struct Footage {
    /// What it is called.
    pub name: String,
    /// What rays see at each instant.
    states: Vec<FrameState>,
    /// The pictures of each; instants that look alike share theirs.
    pictures: Vec<Pictures>,
    display: Display,
    /// Of each picture: how much of each of its pixels the eye sees at the pixel of the screen that it covers.
    weights: Vec<Vec<f32>>,
    /// What the eye sees at each instant.
    truths: Vec<Arc<Picture>>,
}

impl Footage {
    /// Draws a scenario complete, on a display of such a raster; `shown` is told how many instants are done. None if `stop`
    /// is set meanwhile.
    ///
    /// # Errors
    /// The scene cannot be drawn.
    pub fn draw(
        scenario: &Scenario,
        display: &Display,
        [width, height]: [u32; 2],
        source: &Arc<dyn BrickSource>,
        stop: &AtomicBool,
        shown: &dyn Fn(usize),
    ) -> Result<Option<Self>, FrontendError> {
        let display = display.with_rasters(width, height);
        let (projectors, weights) = eye_of(&display, display.observer_in_display)?;
        let options = RendererOptions {
            device: DeviceChoice::Cpu,
            caster: CasterChoice::Auto,
            cache_bytes: 512 << 20,
            ..RendererOptions::in_process(display.clone(), projectors)
        };
        let failed = |error: renderer::RenderError| FrontendError::Volume(error.to_string());
        let (mut renderer, _) = Renderer::new(&options, Arc::clone(source)).map_err(failed)?;
        let mut pictures: Vec<Pictures> = Vec::with_capacity(scenario.states.len());
        for (instant, state) in scenario.states.iter().enumerate() {
            if stop.load(Ordering::SeqCst) {
                return Ok(None);
            }
            let before = instant.checked_sub(1).filter(|&before| scenario.states[before].is_seen_as(state));
            let now = match before {
                Some(before) => Arc::clone(&pictures[before]),
                None => {
                    let mut images = Vec::new();
                    let mut sink = |event| {
                        if let RenderEvent::Image(image) = event {
                            images.push(image);
                        }
                    };
                    // Row planes are many times as fast, where they can draw it.
                    let state = FrameState { welcomes_planes: true, ..state.clone() };
                    renderer.draw(&state, &mut sink).map_err(failed)?;
                    Arc::new(images)
                }
            };
            pictures.push(now);
            shown(instant + 1);
        }
        let (name, states) = (scenario.name.clone(), scenario.states.clone());
        let mut footage = Self { name, states, pictures, display, weights, truths: Vec::new() };
        for instant in 0..footage.len() {
            let is_as_before =
                instant > 0 && Arc::ptr_eq(&footage.pictures[instant], &footage.pictures[instant - 1]);
            let truth = match footage.truths.last().filter(|_| is_as_before) {
                Some(before) => Arc::clone(before),
                None => Arc::new(footage.eye(footage.pictures[instant].iter().map(|one| &one.rgba[..]))),
            };
            footage.truths.push(truth);
        }
        Ok(Some(footage))
    }

    /// Instants.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// The latest instant at a time; None after the last.
    pub fn instant_at(&self, now: Duration) -> Option<usize> {
        let instant = (now.as_secs_f64() * RATE_HZ + 1e-6) as usize;
        (instant < self.len()).then_some(instant)
    }

    /// The display that it was drawn for.
    pub fn display(&self) -> &Display {
        &self.display
    }

    /// The complete pictures of an instant.
    pub fn pictures(&self, instant: usize) -> &[ProjectorImage] {
        &self.pictures[instant]
    }

    /// Whether rays see the same at two instants.
    pub fn is_same(&self, a: usize, b: usize) -> bool {
        Arc::ptr_eq(&self.pictures[a], &self.pictures[b]) || self.states[a].is_seen_as(&self.states[b])
    }

    /// What the eye should see at an instant.
    pub fn truth(&self, instant: usize) -> &Picture {
        &self.truths[instant]
    }

    /// What the eye sees of some pictures, those of an instant or what was made of them.
    pub fn eye<'a>(&self, pictures: impl Iterator<Item = &'a [f32]>) -> Picture {
        let raster = &self.display.projectors[0].raster;
        let mut rgba = vec![0.0; 4 * raster.width as usize * raster.height as usize];
        for (picture, weights) in pictures.zip(&self.weights) {
            let pixels = rgba.chunks_exact_mut(4).zip(picture.chunks_exact(4)).zip(weights);
            for ((sum, pixel), weight) in pixels.filter(|(_, weight)| **weight > 0.0) {
                (0..4).for_each(|i| sum[i] += weight * pixel[i]);
            }
        }
        Picture { width: raster.width, height: raster.height, rgba }
    }
}

/// The projectors that an eye sees at all, and how much of each of their pixels. They all cover the screen alike, so that a
/// pixel of one lies on the same pixel of the others.
fn eye_of(display: &Display, eye: DVec3) -> Result<(Vec<u32>, Vec<Vec<f32>>), FrontendError> {
    let model = EyeModel::new(display, eye).map_err(|error| FrontendError::Display(error.to_string()))?;
    let raster = &display.projectors[0].raster;
    let mut weights: BTreeMap<u32, Vec<f32>> = BTreeMap::new();
    for row in 0..raster.height {
        for column in 0..raster.width {
            for (projector, weight) in model.weights(raster.pixel_on_screen(column, row)) {
                let none = || vec![0.0; raster.width as usize * raster.height as usize];
                let of = weights.entry(projector as u32).or_insert_with(none);
                of[(row * raster.width + column) as usize] = weight as f32;
            }
        }
    }
    Ok(weights.into_iter().unzip())
}
