//! What a frame is cast with: the scene's numbers, and each projector's rays.

use super::RenderError;
use bricks::OctreeShape;
use display_config::{Display, Projector};
use protocol::FrameState;
use twin::{Placement, ProjectorRays, SceneNumbers};

/// The numbers that all projectors share, as kernels read them.
pub(super) fn scene_numbers(display: &Display, frame: &FrameState, shape: &OctreeShape) -> SceneNumbers<f32> {
    let place = Placement {
        display_from_volume: frame.display_from_volume,
        dims: shape.dims(),
        finest_depth: shape.finest_depth(),
        voxel_m: frame.voxel_m(),
        resolution: display.resolution(),
    };
    SceneNumbers::new(place, &frame.optics, frame.light, &frame.quality).rounded()
}

/// The rays of all projectors, as kernels read them.
///
/// # Errors
/// The observer or η of the frame does not go with a projector.
pub(super) fn rays_of(display: &Display, frame: &FrameState) -> Result<Vec<ProjectorRays<f32>>, RenderError> {
    let canonical = display.canonical_raster();
    let rays = |(projector, found): (usize, &Projector)| {
        let law = display
            .beam_law(projector, frame.observer_in_display, frame.eta)
            .map_err(|error| RenderError::Ray { projector: found.name.clone(), why: error.to_string() })?;
        Ok(ProjectorRays::new(&canonical, found, &law).rounded())
    };
    display.projectors.iter().enumerate().map(rays).collect()
}
