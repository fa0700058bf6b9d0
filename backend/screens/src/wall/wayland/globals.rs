//! What a Wayland desktop offers to those who open windows.

use crate::ScreenError;
use wayland_client::globals::{BindError, GlobalList};
use wayland_client::protocol::wl_buffer::WlBuffer;
use wayland_client::protocol::wl_callback::WlCallback;
use wayland_client::protocol::wl_compositor::WlCompositor;
use wayland_client::protocol::wl_seat::WlSeat;
use wayland_client::protocol::wl_shm::WlShm;
use wayland_client::protocol::wl_shm_pool::WlShmPool;
use wayland_client::protocol::wl_surface::WlSurface;
use wayland_client::{Dispatch, QueueHandle};
use wayland_protocols::wp::idle_inhibit::zv1::client::zwp_idle_inhibit_manager_v1::ZwpIdleInhibitManagerV1;
use wayland_protocols::wp::idle_inhibit::zv1::client::zwp_idle_inhibitor_v1::ZwpIdleInhibitorV1;
use wayland_protocols::wp::presentation_time::client::wp_presentation::WpPresentation;
use wayland_protocols::wp::presentation_time::client::wp_presentation_feedback::WpPresentationFeedback;
use wayland_protocols::wp::viewporter::client::wp_viewport::WpViewport;
use wayland_protocols::wp::viewporter::client::wp_viewporter::WpViewporter;
use wayland_protocols::xdg::shell::client::xdg_surface::XdgSurface;
use wayland_protocols::xdg::shell::client::xdg_toplevel::XdgToplevel;
use wayland_protocols::xdg::shell::client::xdg_wm_base::XdgWmBase;
use wayland_protocols::xdg::xdg_output::zv1::client::zxdg_output_manager_v1::ZxdgOutputManagerV1;

/// Who hears what the desktop tells of windows; `usize` is a window's index, `u32` the number of what it shows.
pub trait Hears:
    Dispatch<WlCompositor, ()>
    + Dispatch<WlShm, ()>
    + Dispatch<XdgWmBase, ()>
    + Dispatch<WpPresentation, ()>
    + Dispatch<WpViewporter, ()>
    + Dispatch<ZwpIdleInhibitManagerV1, ()>
    + Dispatch<ZxdgOutputManagerV1, ()>
    + Dispatch<WlSeat, ()>
    + Dispatch<WlSurface, ()>
    + Dispatch<XdgSurface, usize>
    + Dispatch<XdgToplevel, usize>
    + Dispatch<WpViewport, ()>
    + Dispatch<ZwpIdleInhibitorV1, ()>
    + Dispatch<WlShmPool, ()>
    + Dispatch<WlBuffer, usize>
    + Dispatch<WlCallback, (usize, u32)>
    + Dispatch<WpPresentationFeedback, (usize, u32)>
    + 'static
{
}

/// What a desktop offers.
pub struct Globals<H> {
    pub queue: QueueHandle<H>,
    pub compositor: WlCompositor,
    pub shm: WlShm,
    pub base: XdgWmBase,
    /// None where it does not say when it has shown something.
    pub presentation: Option<WpPresentation>,
    /// None where it scales whole windows alone.
    pub viewporter: Option<WpViewporter>,
    pub inhibitors: Option<ZwpIdleInhibitManagerV1>,
    /// None where it does not say where outputs are.
    pub places: Option<ZxdgOutputManagerV1>,
    /// The mouse, whose pointer is not to be seen on a window.
    _seat: Option<WlSeat>,
}

impl<H: Hears> Globals<H> {
    /// Binds them.
    ///
    /// # Errors
    /// Something that is needed is not offered.
    pub fn bind(offered: &GlobalList, queue: &QueueHandle<H>) -> Result<Self, ScreenError> {
        Ok(Self {
            compositor: offered.bind(queue, 4..=5, ()).map_err(|e| lacks("wl_compositor 4", &e))?,
            shm: offered.bind(queue, 1..=1, ()).map_err(|e| lacks("wl_shm", &e))?,
            base: offered.bind(queue, 1..=1, ()).map_err(|e| lacks("xdg_wm_base", &e))?,
            presentation: offered.bind(queue, 1..=1, ()).ok(),
            viewporter: offered.bind(queue, 1..=1, ()).ok(),
            inhibitors: offered.bind(queue, 1..=1, ()).ok(),
            places: offered.bind(queue, 1..=1, ()).ok(),
            _seat: offered.bind(queue, 1..=5, ()).ok(),
            queue: queue.clone(),
        })
    }
}

fn lacks(what: &str, error: &BindError) -> ScreenError {
    ScreenError::Desktop { what: format!("{what} ({error})"), advice: "take another, or an X server" }
}
