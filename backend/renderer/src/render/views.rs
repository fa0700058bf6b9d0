//! The views of a frame: one per projector.

use super::RenderError;
use bricks::OctreeShape;
use display_config::{BeamLaw, Display};
use protocol::FrameState;
use shaders::twin::View;
use shaders::twin::view::Placement;

/// One projector's view.
#[derive(Clone, Debug)]
pub(super) struct ProjectorView {
    /// Index of the projector in the display.
    pub(super) projector: u32,
    /// What a kernel reads.
    pub(super) view: View<f32>,
}

/// The view of one projector, in f64.
///
/// # Errors
/// The observer or η of the frame does not go with the projector.
pub fn view_of(
    display: &Display,
    projector: u32,
    frame: &FrameState,
    shape: &OctreeShape,
) -> Result<View<f64>, RenderError> {
    let found = &display.projectors[projector as usize];
    let law = BeamLaw::new(found.centre_in_display, frame.observer_in_display, frame.eta)
        .map_err(|error| RenderError::Ray { projector: found.name.clone(), why: error.to_string() })?;
    let place = Placement {
        raster: &found.raster,
        law: &law,
        display_from_volume: frame.display_from_volume,
        dims: shape.dims(),
        finest_depth: shape.finest_depth(),
        resolution: (display.pixel_size_m, 2.0 * (0.5 * display.angular_accuracy).tan()),
    };
    Ok(View::new(place, &frame.optics, frame.light_in_effect(), &frame.quality))
}

/// The views of some projectors, as kernels read them.
pub(super) fn views(
    display: &Display,
    projectors: &[u32],
    frame: &FrameState,
    shape: &OctreeShape,
) -> Result<Vec<ProjectorView>, RenderError> {
    projectors
        .iter()
        .map(|&projector| {
            Ok(ProjectorView { projector, view: view_of(display, projector, frame, shape)?.rounded() })
        })
        .collect()
}
