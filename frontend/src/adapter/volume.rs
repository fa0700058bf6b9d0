//! Volumes, opened for work in this process.

use crate::FrontendError;
use crate::scene::{LookChoice, LookName, Scene, VolumeFacts, WishedLook, read_values, verdict};
use crate::staging::Looks;
use bricks::BrickSource;
use protocol::VolumeRef;
use std::sync::Arc;

/// Opens the volume of a scene to learn what it is, and gives the scene the look that it wishes for.
pub fn meet_volume(scene: &mut Scene) -> Result<(VolumeFacts, Option<LookChoice>), FrontendError> {
    let volume = open_scene_volume(scene)?;
    Ok((VolumeFacts::of(volume.as_ref()), scene.fit_look(volume.as_ref())))
}

/// The looks that the volume of a scene may be shown in, of which it has `shown`: none where the scene has one of its own.
pub fn looks_of(scene: &Scene, shown: Option<&LookChoice>) -> Result<Looks, FrontendError> {
    if scene.wish.look == WishedLook::Own {
        return Ok(Looks::default());
    }
    let values = read_values(open_scene_volume(scene)?.as_ref());
    let names = LookName::ALL.into_iter().filter(|&name| verdict(name, &values).fits).collect();
    Ok(Looks { values: Some(values), names, shown: shown.map(|look| look.name) })
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
