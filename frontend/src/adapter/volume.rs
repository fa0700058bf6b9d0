//! Volumes, opened for work in this process.

use crate::FrontendError;
use crate::scene::{LookChoice, Scene, VolumeFacts};
use bricks::BrickSource;
use protocol::VolumeRef;
use std::sync::Arc;

/// Opens the volume of a scene to learn what it is, and gives the scene the look that it wishes for.
pub fn meet_volume(scene: &mut Scene) -> Result<(VolumeFacts, Option<LookChoice>), FrontendError> {
    let volume = open_scene_volume(scene)?;
    Ok((VolumeFacts::of(volume.as_ref()), scene.fit_look(volume.as_ref())))
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
