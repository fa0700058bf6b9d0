//! Windows that the renderer's GPU paints.

use protocol::SwapchainChoice;
use renderer::Renderer;
use screens::OutputWall;
#[cfg(feature = "gpu")]
use {
    glam::UVec2,
    protocol::Canvas,
    renderer::device::gpu::Swapchains,
    screens::{NativeWindow, Painter},
};

/// Its GPU, as what paints windows.
#[cfg(feature = "gpu")]
struct Gpu(Swapchains);

#[cfg(feature = "gpu")]
impl Painter for Gpu {
    fn longest_edge(&self) -> u32 {
        self.0.longest_edge()
    }

    fn canvas(&self, window: NativeWindow, size: UVec2) -> Result<Box<dyn Canvas>, String> {
        Ok(Box::new(self.0.open(window, size).map_err(|error| error.to_string())?))
    }
}

const NO_GPU: &str = "--swapchain on needs --device gpu";

/// Has a renderer's GPU paint the windows of a wall, where that is wanted. Which way pictures take to them, as the end of a
/// sentence; None where it is the only one there is.
///
/// # Errors
/// It is wanted, and cannot be.
#[cfg(feature = "gpu")]
pub fn paint(
    wall: &mut dyn OutputWall,
    renderer: &Renderer,
    choice: SwapchainChoice,
) -> Result<Option<String>, String> {
    let swapchains = match (choice, renderer.swapchains()) {
        (SwapchainChoice::Off, _) | (SwapchainChoice::Auto, None) => return Ok(None),
        (SwapchainChoice::Auto, Some(swapchains)) if swapchains.is_software() => return Ok(None),
        (SwapchainChoice::On, None) => return Err(NO_GPU.to_owned()),
        (_, Some(swapchains)) => swapchains,
    };
    match (wall.paint_by(Box::new(Gpu(swapchains))), choice) {
        (Ok(()), _) => Ok(Some("it paints its windows".to_owned())),
        (Err(error), SwapchainChoice::On) => Err(format!("{error}; take --swapchain off")),
        (Err(error), _) => Ok(Some(format!("its windows get their pictures from main memory: {error}"))),
    }
}

/// The same where there is no GPU.
#[cfg(not(feature = "gpu"))]
pub fn paint(
    _: &mut dyn OutputWall,
    _: &Renderer,
    choice: SwapchainChoice,
) -> Result<Option<String>, String> {
    if choice == SwapchainChoice::On { Err(NO_GPU.to_owned()) } else { Ok(None) }
}
