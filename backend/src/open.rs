//! The renderer that a back-end opens when it is set up.

use crate::painting::paint;
use bricks::procedural::ProceduralVolume;
use bricks::store::Store;
use bricks::{BrickSource, NodeKey};
use protocol::{
    Advance, CodesAt, DeviceInfo, DrawError, FrameState, Held, ProjectorImage, Render, ScreenPicture, Setup,
    StopAsked, VolumeRef, Wall,
};
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
    let mut wall = if setup.screens.outputs { Some(open_wall(&setup)?) } else { None };
    let volume = setup.volume.clone();
    let (mut renderer, mut info) = renderer_of(&mut setup, &volume)?;
    if let Some(wall) = &mut wall {
        let way = paint(wall.as_mut(), &renderer, setup.screens.swapchain)?;
        info.reason.extend(way.map(|way| format!("; {way}")));
    }
    if let Some(path) = &setup.trace {
        renderer.record(path.clone(), &setup.volume);
    }
    let wall = wall.map(|wall| -> Box<dyn Wall> { wall });
    Ok(Opened { wall, ..Opened::new(Box::new(Changing { setup, volume, renderer: Some(renderer) }), info) })
}

fn renderer_of(setup: &mut Setup, volume: &VolumeRef) -> Result<(Renderer, DeviceInfo), String> {
    let (mut renderer, info) =
        Renderer::new(&setup.options, open_volume(volume)?).map_err(|error| error.to_string())?;
    if let Some(held) = setup.held.take_if(|held| held.volume == *volume) {
        renderer.expect(held.nodes.into_iter().map(|(depth, cell)| NodeKey { depth, cell }).collect());
    }
    Ok((renderer, info))
}

/// A renderer of one volume after the other, as frames say.
struct Changing {
    setup: Setup,
    /// The one that is open.
    volume: VolumeRef,
    /// None where the one that was wanted last could not be opened.
    renderer: Option<Renderer>,
}

impl Changing {
    fn renderer(&mut self) -> Result<&mut Renderer, DrawError> {
        self.renderer.as_mut().ok_or_else(|| DrawError("its volume could not be opened".to_owned()))
    }

    /// Opens a volume in place of the one that is open. There is room for the bricks of one of them.
    fn turn_to(&mut self, volume: &VolumeRef) -> Result<(), DrawError> {
        if let Some(mut renderer) = self.renderer.take() {
            renderer.finish()?;
        }
        self.renderer = Some(renderer_of(&mut self.setup, volume).map_err(DrawError)?.0);
        self.volume = volume.clone();
        Ok(())
    }
}

impl Render for Changing {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        let volume = frame.volume.as_ref().unwrap_or(&self.setup.volume).clone();
        if volume != self.volume {
            self.turn_to(&volume)?;
        }
        Ok(self.renderer()?.restart(frame)?)
    }

    fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError> {
        Ok(self.renderer()?.advance(stop)?)
    }

    fn present(&mut self, sink: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        Ok(self.renderer()?.present(sink)?)
    }

    fn present_on_screens(
        &mut self,
        at: CodesAt,
        sink: &mut dyn FnMut(ScreenPicture),
    ) -> Result<(), DrawError> {
        Ok(self.renderer()?.present_on_screens(at, sink)?)
    }

    fn compare_with(&mut self, newest: &FrameState) {
        // Of another volume nothing is open.
        let volume = newest.volume.as_ref().unwrap_or(&self.setup.volume);
        if let Some(renderer) = self.renderer.as_mut().filter(|_| *volume == self.volume) {
            renderer.compare_with(newest);
        }
    }

    fn held(&mut self) -> Option<Held> {
        let nodes = self.renderer.as_mut()?.shown_bricks()?;
        let nodes = nodes.into_iter().map(|NodeKey { depth, cell }| (depth, cell)).collect();
        Some(Held { volume: self.volume.clone(), nodes })
    }

    fn finish(&mut self) -> Result<(), DrawError> {
        Ok(self.renderer()?.finish()?)
    }
}

fn open_wall(setup: &Setup) -> Result<Box<dyn OutputWall>, String> {
    screens::open_wall(&setup.options.display, &setup.options.projectors).map_err(|error| error.to_string())
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
