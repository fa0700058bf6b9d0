//! The renderer that a back-end opens when it is set up.

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use bricks::store::Store;
use protocol::{Setup, VolumeRef, Wall};
use renderer::Renderer;
use screens::OutputWall;
use std::sync::Arc;
use transport::Opened;
use transport::local_rank;

/// Opens the volume and the device that `setup` names. Ranks of one host take its adapters in turn, by their places on that
/// host where the launcher says them.
///
/// # Errors
/// One sentence: the volume cannot be opened, or there is no such device.
pub fn open_renderer(mut setup: Setup) -> Result<Opened, String> {
    setup.options.adapter.turn = local_rank().unwrap_or(setup.options.adapter.turn);
    // First, so that outputs are black while a large volume opens.
    let wall = if setup.screens.outputs { Some(open_wall(&setup)?) } else { None };
    let source = open_volume(&setup.volume)?;
    let (mut renderer, info) = Renderer::new(&setup.options, source).map_err(|error| error.to_string())?;
    if let Some(path) = setup.trace {
        renderer.record(path, &setup.volume);
    }
    Ok(Opened { wall, ..Opened::new(Box::new(renderer), info) })
}

fn open_wall(setup: &Setup) -> Result<Box<dyn Wall>, String> {
    let wall = OutputWall::open(&setup.options.display, &setup.options.projectors);
    Ok(Box::new(wall.map_err(|error| error.to_string())?))
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
