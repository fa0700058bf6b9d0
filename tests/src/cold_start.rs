//! A cold start: a still view from its coarsest brick on until all its detail has come.

use crate::draw::draw_with;
use crate::motion::{FRAMES_PER_SECOND, Spread, steps};
use protocol::{FrameState, ProjectorImage};
use renderer::Renderer;
use std::time::{Duration, Instant};

/// What came of a cold start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColdStart {
    /// What pixels change by from one frame to the next: the largest of each over all frames.
    pub step: Spread,
    /// The same of those pixels that are looked at.
    pub step_on_surfaces: Spread,
    /// Seconds on the frames' clock from the coarsest brick until nothing changes any more; None where it still does.
    pub rest_s: Option<f64>,
    /// Frames from the coarsest brick on.
    pub frames: u32,
}

/// Draws a live frame again and again, 1/60 s apart, until it is complete, `most` times at most. Of the only projector
/// `is_surface` tells which pixels show a surface when all detail is there, row by row. Reading and loading take real
/// time: a frame that is drawn sooner waits for its 1/60 s, and one that takes longer gives them more.
pub fn cold_start(
    renderer: &mut Renderer,
    frame: &FrameState,
    most: u32,
    is_surface: impl Fn(usize) -> bool,
) -> ColdStart {
    let none = Spread::of(Vec::new());
    let mut found = ColdStart { step: none, step_on_surfaces: none, rest_s: None, frames: 0 };
    let mut last: Option<ProjectorImage> = None;
    for index in 0..most {
        let begun = Instant::now();
        let time_s = f64::from(index) / FRAMES_PER_SECOND;
        let (images, report) = draw_with(renderer, &FrameState { index, time_s, ..frame.clone() });
        let image = images.into_iter().next().expect("one projector is drawn");
        if let Some(last) = &last {
            let changes = steps(last, &image);
            let on_surfaces = changes.iter().enumerate().filter(|&(pixel, _)| is_surface(pixel));
            let on_surfaces = Spread::of(on_surfaces.map(|(_, &change)| change).collect());
            found.step_on_surfaces = found.step_on_surfaces.max(on_surfaces);
            found.step = found.step.max(Spread::of(changes));
        }
        last = Some(image);
        // The coarsest brick itself appears out of the dark.
        if report.bricks_resident > 0 {
            found.frames += 1;
            if report.complete {
                found.rest_s = Some(f64::from(found.frames - 1) / FRAMES_PER_SECOND);
                break;
            }
        }
        std::thread::sleep(Duration::from_secs_f64(1.0 / FRAMES_PER_SECOND).saturating_sub(begun.elapsed()));
    }
    found
}
