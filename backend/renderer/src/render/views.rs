//! What a frame is cast with: the scene's numbers, and each projector's rays.

use super::RenderError;
use bricks::OctreeShape;
use display_config::Display;
use protocol::FrameState;
use shaders::twin::{Placement, ProjectorRays, SceneNumbers};

/// One projector's view.
#[derive(Clone, Debug)]
pub(super) struct ProjectorView {
    /// Index of the projector in the display.
    pub(super) projector: u32,
    /// What a kernel reads.
    pub(super) rays: ProjectorRays<f32>,
}

/// The numbers that all projectors share, as kernels read them.
pub(super) fn scene_numbers(display: &Display, frame: &FrameState, shape: &OctreeShape) -> SceneNumbers<f32> {
    let place = Placement {
        display_from_volume: frame.display_from_volume,
        dims: shape.dims(),
        finest_depth: shape.finest_depth(),
        voxel_m: frame.voxel_m(),
        resolution: display.resolution(),
    };
    SceneNumbers::new(place, &frame.optics, frame.light_in_effect(), &frame.quality).rounded()
}

/// The views of some projectors, as kernels read them.
///
/// # Errors
/// The observer or η of the frame does not go with a projector.
pub(super) fn views(
    display: &Display,
    projectors: &[u32],
    frame: &FrameState,
) -> Result<Vec<ProjectorView>, RenderError> {
    let canonical = display.canonical_raster();
    let view = |&projector: &u32| {
        let found = &display.projectors[projector as usize];
        let law = display
            .beam_law(projector as usize, frame.observer_in_display, frame.eta)
            .map_err(|error| RenderError::Ray { projector: found.name.clone(), why: error.to_string() })?;
        Ok(ProjectorView { projector, rays: ProjectorRays::new(&canonical, found, &law).rounded() })
    };
    projectors.iter().map(view).collect()
}
