//! Volumes, opened for work in this process.

use crate::FrontendError;
use crate::scene::{Scene, VolumeFacts};
use bricks::BrickSource;
use protocol::VolumeRef;
use std::sync::Arc;

/// Opens the volume of a scene just to learn what it is.
pub fn scene_facts(scene: &Scene) -> Result<VolumeFacts, FrontendError> {
    Ok(VolumeFacts::of(open_scene_volume(scene)?.as_ref()))
}

/// Opens the volume of a scene for work in this process. What is wrong with it is told with the place that names it.
pub fn open_scene_volume(scene: &Scene) -> Result<Arc<dyn BrickSource>, FrontendError> {
    let told = |sentence: String| match &scene.source_place {
        Some(place) => FrontendError::Volume(format!("{place}: {sentence}")),
        None => FrontendError::Volume(sentence),
    };
    backend::open_volume(&scene.volume_ref()).map_err(told)
}

/// Opens a volume for work in this process.
pub(super) fn open_volume(volume: &VolumeRef) -> Result<Arc<dyn BrickSource>, FrontendError> {
    backend::open_volume(volume).map_err(FrontendError::Volume)
}
