//! A display of no projectors, a frame and a report, for the tests of sessions.

use display_config::Display;
use glam::{DAffine3, DVec3, UVec3};
use optics::{Curve, Optics};
use protocol::{
    DeviceInfo, FrameReport, FrameState, Held, RendererOptions, Screens, Setup, Stages, VolumeRef,
};

pub(crate) fn setups(count: u32) -> Vec<Setup> {
    let display = Display {
        name: "fake".to_owned(),
        width_m: 1.0,
        height_m: 1.0,
        pixel_size_m: 1e-3,
        angular_accuracy: 0.01,
        observer_in_display: DVec3::Z,
        eta: 1.0,
        rate_hz: 60.0,
        projectors: Vec::new(),
        adapters: Vec::new(),
    };
    let options =
        |backend| RendererOptions { backend, ..RendererOptions::in_process(display.clone(), vec![backend]) };
    let volume = || VolumeRef::Store("fake.lloom".into());
    let setup = |backend| Setup {
        options: options(backend),
        volume: volume(),
        trace: None,
        screens: Screens::default(),
        is_kept: false,
        held: None,
    };
    (0..count).map(setup).collect()
}

/// The device of a back-end that takes the place of one, of which it knows this.
pub(crate) fn device_after(held: Option<Box<Held>>) -> DeviceInfo {
    let reason = held.map_or_else(|| device().reason, |held| format!("{held:?}"));
    DeviceInfo { reason, ..device() }
}

/// What one shows.
pub(crate) fn held() -> Held {
    let nodes = vec![(0, UVec3::ZERO), (1, UVec3::X)];
    Held { volume: VolumeRef::Store("fake.lloom".into()), nodes }
}

pub(crate) fn frame(index: u32) -> FrameState {
    let optics = Optics::grey(Curve::constant(1.0));
    FrameState { index, ..FrameState::still(DVec3::Z, DAffine3::IDENTITY, optics) }
}

pub(crate) fn report(frame: u32, backend: u32) -> FrameReport {
    FrameReport {
        caster: protocol::Caster::Rays,
        frame,
        backend,
        projectors: vec![backend],
        rays: 1,
        samples: 1,
        bricks_wanted: 0,
        bricks_resident: 0,
        bricks_loaded: 0,
        bytes_loaded: 0,
        working_set_union: 0,
        working_set_sum: None,
        complete: true,
        shortfall: String::new(),
        upkeep: None,
        refined: None,
        damaged_bricks: 0,
        damaged: Vec::new(),
        stages: Stages::default(),
        total_ms: 0.0,
    }
}

pub(crate) fn device() -> DeviceInfo {
    let [adapter, reason, filter] = ["fake", "a test", "exact"].map(str::to_owned);
    DeviceInfo { adapter, reason, filter, cache_bytes: 1 << 20 }
}
