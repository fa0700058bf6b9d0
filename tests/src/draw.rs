//! A scene drawn by a device.

use bricks::BrickSource;
use display_config::Display;
use protocol::{
    DeviceChoice, DeviceInfo, FilterChoice, FrameReport, FrameState, ProjectorImage, RenderEvent, Setup,
    VolumeRef,
};
use renderer::Renderer;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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

/// How to draw.
#[derive(Clone, Copy, Debug)]
pub struct With {
    /// The device.
    pub device: DeviceChoice,
    /// The interpolation.
    pub filter: FilterChoice,
    /// The brick cache, bytes.
    pub cache_bytes: u64,
}

impl With {
    /// A device at its defaults.
    pub fn device(device: DeviceChoice) -> Self {
        Self { device, filter: FilterChoice::Auto, cache_bytes: 256 << 20 }
    }
}

/// A renderer for some projectors of a display.
pub fn renderer(
    display: &Display,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    with: With,
) -> (Renderer, DeviceInfo) {
    let setup = Setup {
        display: display.clone(),
        projectors: projectors.to_vec(),
        backend: 0,
        volume: VolumeRef::Store("given by the test".into()),
        device: with.device,
        filter: with.filter,
        cache_bytes: with.cache_bytes,
        trace: None,
    };
    Renderer::new(&setup, Arc::clone(source)).expect("the device was found before")
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

/// Draws one frame with a renderer that may have drawn others.
pub fn draw_with(renderer: &mut Renderer, frame: &FrameState) -> (Vec<ProjectorImage>, FrameReport) {
    let mut images = Vec::new();
    let mut sink = |event| {
        if let RenderEvent::Image(image) = event {
            images.push(image);
        }
    };
    let report = renderer.draw(frame, &mut sink).expect("a test scene can be drawn");
    (images, report)
}

/// A turn: tests that hold one run one after the other. A device uses all cores, and a GPU is not shared.
pub fn turn() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    // A test that failed while it held the turn has said so itself.
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whether there is a GPU to test. Its lack is told aloud, and is a failure where LIGHTLOOM_REQUIRE_GPU=1.
pub fn has_gpu() -> bool {
    devices().contains(&DeviceChoice::Gpu)
}

/// The devices to test: the CPU, and the GPU where there is one. Its lack is told aloud, and is a failure where
/// LIGHTLOOM_REQUIRE_GPU=1.
pub fn devices() -> Vec<DeviceChoice> {
    #[cfg(feature = "gpu")]
    let gpu = renderer::device::gpu::adapter_name().map_err(|error| error.to_string());
    #[cfg(not(feature = "gpu"))]
    let gpu: Result<String, String> = Err("the tests were built without the gpu feature".into());
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
