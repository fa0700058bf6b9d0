//! Scenes by their names on the command line.

use super::names::PROCEDURAL_PREFIX;
use super::{Look, Scene, SceneError, VolumeSource, builtin, read};
use optics::Optics;
use std::path::Path;

impl Scene {
    /// The scene of a command-line argument: a TOML file, `procedural:NAME[@VOXELS]`, or a store, whatever its name.
    pub fn load(argument: &str) -> Result<Self, SceneError> {
        if let Some(name) = argument.strip_prefix(PROCEDURAL_PREFIX) {
            return Ok(builtin::procedural_scene(argument, VolumeSource::procedural(name)?));
        }
        let path = Path::new(argument);
        match path.extension().and_then(|e| e.to_str()) {
            Some("toml") => read::scene_from_file(path),
            Some("lloom") if !path.is_file() => {
                Err(SceneError::NoStore { place: None, path: path.to_owned() })
            }
            _ if path.is_file() => Ok(builtin::store_scene(path)),
            _ => Err(SceneError::NotAScene { argument: argument.to_owned() }),
        }
    }

    /// What a scene file shows of any volume, one [`Optics`] for each look that its keyframes give it: of these, only
    /// which data values they show means anything. The scene's own volume need not be there.
    ///
    /// # Errors
    /// A file that is no scene, or one whose look depends on the volume.
    pub fn visibility_in_file(path: &Path) -> Result<Vec<Optics>, SceneError> {
        let scene = read::scene_without_volume(path)?;
        let Look::InDataUnits(look) = &scene.look else {
            return Err(SceneError::RelativeLook { path: path.to_owned() });
        };
        let shown = |time_s| look.edited(&scene.edits, time_s).visibility(&scene.chain_at(time_s));
        let failed = |reason| SceneError::UnclearLook { path: path.to_owned(), reason };
        scene.edits.times().map(|time_s| shown(time_s).map_err(failed)).collect()
    }
}
