//! The renderer that a back-end opens when it is set up.

use super::worker::{Draw, DrawEvent, Opened};
use crate::protocol::{FrameReport, FrameState, Setup, VolumeRef};
use crate::render::{RenderEvent, Renderer};
use crate::store::{BrickSource, Store};
use crate::volume::procedural::ProceduralVolume;
use std::sync::Arc;

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

impl Draw for Renderer {
    fn draw(&mut self, frame: &FrameState, sink: &mut dyn FnMut(DrawEvent)) -> Result<FrameReport, String> {
        let mut pass_on = |event| {
            sink(match event {
                RenderEvent::Progress { done, total } => DrawEvent::Progress { done, total },
                RenderEvent::Image(image) => DrawEvent::Image(image),
            });
        };
        Renderer::draw(self, frame, &mut pass_on).map_err(|error| error.to_string())
    }

    fn finish(&mut self) -> Result<(), String> {
        Renderer::finish(self).map_err(|error| error.to_string())
    }
}
