//! The renderer that a back-end opens when it is set up.

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use bricks::store::Store;
use protocol::{Setup, VolumeRef};
use renderer::Renderer;
use std::sync::Arc;
use transport::worker::Opened;

/// Opens the volume and the device that `setup` names.
///
/// # Errors
/// One sentence: the volume or the device cannot be opened.
pub fn open_renderer(setup: Setup) -> Result<Opened, String> {
    let source = open_volume(&setup.volume)?;
    let (renderer, info) = Renderer::new(&setup, source).map_err(|error| error.to_string())?;
    Ok((Box::new(renderer), info))
}

/// Opens a volume.
///
/// # Errors
/// One sentence that names it.
pub fn open_volume(volume: &VolumeRef) -> Result<Arc<dyn BrickSource>, String> {
    match volume {
        VolumeRef::Store(path) => Ok(Arc::new(Store::open(path).map_err(|error| error.to_string())?)),
        VolumeRef::Procedural { name, dims, voxel_size_m } => {
            let volume = ProceduralVolume::new(name, *dims, voxel_size_m.x);
            Ok(Arc::new(volume.map_err(|error| error.to_string())?))
        }
    }
}
