//! A scene drawn by a device.

use crate::made_once::MadeOnce;
use bricks::BrickSource;
use display_config::Display;
#[cfg(feature = "gpu")]
use protocol::AdapterWish;
use protocol::{
    CasterChoice, DeviceChoice, DeviceInfo, FilterChoice, FrameReport, FrameState, ProjectorImage,
    RenderEvent, RendererOptions,
};
use renderer::{RenderError, Renderer};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Instant;

/// What a device made of a frame.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The pictures, in order of projectors.
    pub images: Vec<ProjectorImage>,
    /// Its account.
    pub report: FrameReport,
    /// The device.
    pub info: DeviceInfo,
}

impl Drawn {
    /// Whether Mesa's llvmpipe left rays: it leaves a shader's loops when the invocations that it runs together have gone round
    /// them some 65,535 times in all, nested or not.
    pub fn is_left_by_llvmpipe(&self) -> bool {
        self.info.adapter.contains("llvmpipe") && self.report.shortfall.contains("rays before their end")
    }
}

/// How to draw.
#[derive(Clone, Copy, Debug)]
pub struct With {
    /// The device.
    pub device: DeviceChoice,
    /// The interpolation.
    pub filter: FilterChoice,
    /// The caster.
    pub caster: CasterChoice,
    /// The brick cache, bytes.
    pub cache_bytes: u64,
}

impl With {
    /// Row planes, at the defaults of the device that `auto` takes them on.
    pub const PLANES: Self = Self { caster: CasterChoice::Planes, ..Self::device(DeviceChoice::Cpu) };
    /// The same on a GPU.
    pub const PLANES_ON_GPU: Self = Self { caster: CasterChoice::Planes, ..Self::device(DeviceChoice::Gpu) };

    /// A device at its defaults.
    pub const fn device(device: DeviceChoice) -> Self {
        Self { device, filter: FilterChoice::Auto, caster: CasterChoice::Rays, cache_bytes: 256 << 20 }
    }
}

/// A renderer for some projectors of a display.
pub fn renderer(
    display: &Display,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    with: With,
) -> (Renderer, DeviceInfo) {
    let options = RendererOptions {
        device: with.device,
        filter: with.filter,
        caster: with.caster,
        cache_bytes: with.cache_bytes,
        ..RendererOptions::in_process(display.clone(), projectors.to_vec())
    };
    Renderer::new(&options, Arc::clone(source)).expect("the device was found before")
}

/// Draws one frame.
pub fn draw(
    display: &Display,
    frame: &FrameState,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    with: With,
) -> Drawn {
    let (mut renderer, info) = renderer(display, source, projectors, with);
    let (images, report) = draw_with(&mut renderer, frame);
    Drawn { images, report, info }
}

/// Draws one frame, where it may be refused.
pub fn try_draw(
    display: &Display,
    frame: &FrameState,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    with: With,
) -> (Result<Vec<ProjectorImage>, RenderError>, DeviceInfo) {
    let (mut renderer, info) = renderer(display, source, projectors, with);
    (try_draw_with(&mut renderer, frame).map(|(images, _)| images), info)
}

/// Whether a frame was refused as Mesa's llvmpipe left rays of it: it leaves a shader's loops when the invocations that it runs
/// together have gone round them some 65,535 times in all, nested or not.
pub fn is_left_by_llvmpipe(error: &RenderError, info: &DeviceInfo) -> bool {
    info.adapter.contains("llvmpipe") && error.to_string().contains("rays before their end")
}

/// One frame, drawn by whoever asks first. Not for tests of whether a device repeats itself.
pub fn drawn_once(
    display: &Display,
    frame: &FrameState,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    with: With,
) -> Arc<Drawn> {
    // The volume is known by its address, which stays its own as long as it is kept here.
    type Kept = (Arc<dyn BrickSource>, Arc<Drawn>);
    static DRAWN: MadeOnce<Kept> = MadeOnce::new();
    let key = format!("{:p} {projectors:?} {with:?} {frame:?} {display:?}", Arc::as_ptr(source));
    let make = || (Arc::clone(source), Arc::new(draw(display, frame, source, projectors, with)));
    Arc::clone(&DRAWN.get(key, make).1)
}

/// Draws one frame with a renderer that may have drawn others.
pub fn draw_with(renderer: &mut Renderer, frame: &FrameState) -> (Vec<ProjectorImage>, FrameReport) {
    try_draw_with(renderer, frame).expect("a test scene can be drawn")
}

/// The same, where it may be refused.
pub fn try_draw_with(
    renderer: &mut Renderer,
    frame: &FrameState,
) -> Result<(Vec<ProjectorImage>, FrameReport), RenderError> {
    let mut images = Vec::new();
    let mut sink = |event| {
        if let RenderEvent::Image(image) = event {
            images.push(image);
        }
    };
    let report = renderer.draw(frame, &mut sink)?;
    Ok((images, report))
}

/// The seconds that a frame takes, its account, and the pictures of the projectors to keep.
pub fn timed(
    renderer: &mut Renderer,
    frame: &FrameState,
    keep: &[u32],
) -> (f64, FrameReport, Vec<ProjectorImage>) {
    let started = Instant::now();
    let mut images = Vec::new();
    let mut sink = |event| match event {
        RenderEvent::Image(image) if keep.contains(&image.projector) => images.push(image),
        RenderEvent::Image(_) | RenderEvent::Progress { .. } => {}
    };
    let report = renderer.draw(frame, &mut sink).expect("the scene of a bench can be drawn");
    (started.elapsed().as_secs_f64(), report, images)
}

/// How many tests draw at once. One would leave cores idle while it compiles a kernel or makes a volume.
const TURNS: usize = 2;

/// The turns that nobody holds.
static FREE_TURNS: (Mutex<usize>, Condvar) = (Mutex::new(TURNS), Condvar::new());

/// A turn to draw, until it is dropped.
#[must_use = "a turn ends when it is dropped"]
pub struct Turn(());

/// Waits for a turn. A drawing takes all cores: many tests at once would only need more memory.
pub fn turn() -> Turn {
    let (free, one_ended) = &FREE_TURNS;
    let free = free.lock().unwrap_or_else(PoisonError::into_inner);
    let mut free = one_ended.wait_while(free, |free| *free == 0).unwrap_or_else(PoisonError::into_inner);
    *free -= 1;
    Turn(())
}

impl Drop for Turn {
    fn drop(&mut self) {
        let (free, one_ended) = &FREE_TURNS;
        *free.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        one_ended.notify_one();
    }
}

/// Whether there is a GPU to test. Its lack is announced, and is a failure where LIGHTLOOM_REQUIRE_GPU=1.
pub fn has_gpu() -> bool {
    devices().contains(&DeviceChoice::Gpu)
}

/// The devices to test: the CPU, and the GPU where there is one. Its lack is announced, and is a failure where
/// LIGHTLOOM_REQUIRE_GPU=1.
pub fn devices() -> Vec<DeviceChoice> {
    #[cfg(feature = "gpu")]
    let gpu = {
        let (wish, filter) = (AdapterWish::default(), FilterChoice::Exact);
        let opened = renderer::device::open_device(
            DeviceChoice::Gpu,
            &wish,
            filter,
            &renderer::device::CacheWish { bytes: 0, slots_needed: 0, has_deviations: false },
        );
        opened.map_err(|error| error.to_string())
    };
    #[cfg(not(feature = "gpu"))]
    let gpu: Result<(), String> = Err("the tests were built without the gpu feature".into());
    match gpu {
        Ok(_) => vec![DeviceChoice::Cpu, DeviceChoice::Gpu],
        Err(why) => {
            println!("SKIPPED: no GPU tests: {why}");
            assert!(
                std::env::var("LIGHTLOOM_REQUIRE_GPU").as_deref() != Ok("1"),
                "a GPU is required here: {why}"
            );
            vec![DeviceChoice::Cpu]
        }
    }
}
