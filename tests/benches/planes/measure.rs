//! One scene drawn by one caster.

use crate::scene::{COMPARED, Scene};
use lightloom_tests::compare::{self, Errors, TruePixel};
use lightloom_tests::draw;
use protocol::{CasterChoice, DeviceChoice, FrameReport, FrameState};
use renderer::Renderer;

/// A whole number from the environment.
pub fn number(name: &str, default: usize) -> usize {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// How often each picture is drawn: the median counts.
pub fn repeats() -> usize {
    number("LIGHTLOOM_BENCH_REPEATS", 3).max(1)
}

/// A renderer for some views of a scene, and the name of what draws.
pub fn renderer(scene: &Scene, caster: CasterChoice, projectors: &[u32]) -> (Renderer, String) {
    let with = draw::With { cache_bytes: 1 << 30, caster, ..draw::With::device(DeviceChoice::Cpu) };
    let (renderer, info) = draw::renderer(&scene.display, &scene.source, projectors, with);
    (renderer, info.adapter)
}

/// What a frame took and how far it was off.
pub struct Measured {
    /// The median.
    pub seconds: f64,
    pub report: FrameReport,
    /// Of its pixels that were compared; None if there were none.
    pub errors: Option<Errors>,
}

impl Measured {
    /// A cell of the errors.
    pub fn codes(&self) -> String {
        self.errors.as_ref().map_or("–".to_owned(), compare::codes)
    }
}

/// Draws a frame some times, and compares those of its pixels that the renderer has.
pub fn measure(renderer: &mut Renderer, frame: &FrameState, truth: &[TruePixel]) -> Measured {
    let mut runs: Vec<_> = (0..repeats()).map(|_| draw::timed(renderer, frame, &COMPARED)).collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (seconds, report, images) = runs.swap_remove((runs.len() - 1) / 2);
    let is_drawn = |pixel: &TruePixel| images.iter().any(|image| image.projector == pixel.projector);
    let kept: Vec<_> = truth.iter().copied().filter(is_drawn).collect();
    let errors = (!kept.is_empty()).then(|| compare::errors(&images, &kept));
    Measured { seconds, report, errors }
}
