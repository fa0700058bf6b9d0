//! A small volume of thin layers of colour on a small display, for the cases at the ends of what is allowed.

use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::scenes::{frame, optics, placed};
use protocol::FrameState;
use std::sync::Arc;

/// One projector from the side and one near the middle.
pub const PROJECTORS: [u32; 2] = [1, 5];

/// desk8 with few pixels.
pub fn display() -> Display {
    Display::load("desk8").unwrap().with_rasters(61, 45)
}

/// 56 voxels along each axis with these values, 0 to 1.
pub fn volume(value: impl Fn(DVec3) -> f64 + Send + Sync + 'static) -> Arc<dyn BrickSource> {
    Arc::new(ClosureVolume::new(UVec3::splat(56), (0.0, 1.0), value))
}

/// The volume in the middle of the screen, turned about y by `turn`, at its finest level everywhere.
pub fn scene(display: &Display, source: &Arc<dyn BrickSource>, turn: f64) -> FrameState {
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.0, 0.0), (0.2, 0.03), (0.8, 0.03)],
        &vec![(0.0, [1.0, 0.0, 0.0]), (0.5, [0.0, 1.0, 0.0]), (1.0, [0.0, 0.0, 1.0])],
    );
    let place = placed(&**source, 0.6 * display.height_m, DQuat::from_rotation_y(turn));
    let mut frame = frame(display, place, optics, None);
    frame.quality.lod_scale = 0.0;
    frame
}
