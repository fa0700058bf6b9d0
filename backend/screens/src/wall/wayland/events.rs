//! What a Wayland desktop tells, and who hears it.

use super::desk::Desk;
use super::globals::Hears;
use super::surface::Surface;
use wayland_client::globals::GlobalListContents;
use wayland_client::protocol::wl_buffer::{self, WlBuffer};
use wayland_client::protocol::wl_callback::{self, WlCallback};
use wayland_client::protocol::wl_compositor::WlCompositor;
use wayland_client::protocol::wl_output::{self, WlOutput};
use wayland_client::protocol::wl_pointer::{self, WlPointer};
use wayland_client::protocol::wl_registry::{self, WlRegistry};
use wayland_client::protocol::wl_seat::{self, Capability, WlSeat};
use wayland_client::protocol::wl_shm::WlShm;
use wayland_client::protocol::wl_shm_pool::WlShmPool;
use wayland_client::protocol::wl_surface::WlSurface;
use wayland_client::{Connection, Dispatch, QueueHandle, WEnum, delegate_noop};
use wayland_protocols::wp::idle_inhibit::zv1::client::zwp_idle_inhibit_manager_v1::ZwpIdleInhibitManagerV1;
use wayland_protocols::wp::idle_inhibit::zv1::client::zwp_idle_inhibitor_v1::ZwpIdleInhibitorV1;
use wayland_protocols::wp::presentation_time::client::wp_presentation::WpPresentation;
use wayland_protocols::wp::presentation_time::client::wp_presentation_feedback::{
    self, WpPresentationFeedback,
};
use wayland_protocols::wp::viewporter::client::wp_viewport::WpViewport;
use wayland_protocols::wp::viewporter::client::wp_viewporter::WpViewporter;
use wayland_protocols::xdg::shell::client::xdg_surface::{self, XdgSurface};
use wayland_protocols::xdg::shell::client::xdg_toplevel::{self, XdgToplevel};
use wayland_protocols::xdg::shell::client::xdg_wm_base::{self, XdgWmBase};
use wayland_protocols::xdg::xdg_output::zv1::client::zxdg_output_manager_v1::ZxdgOutputManagerV1;
use wayland_protocols::xdg::xdg_output::zv1::client::zxdg_output_v1::{self, ZxdgOutputV1};

delegate_noop!(Desk: WlCompositor);
delegate_noop!(Desk: ignore WlShm);
delegate_noop!(Desk: WlShmPool);
delegate_noop!(Desk: ignore WlSurface);
delegate_noop!(Desk: WpViewporter);
delegate_noop!(Desk: WpViewport);
delegate_noop!(Desk: ignore WpPresentation);
delegate_noop!(Desk: ZwpIdleInhibitManagerV1);
delegate_noop!(Desk: ZwpIdleInhibitorV1);
delegate_noop!(Desk: ZxdgOutputManagerV1);

impl Hears for Desk {}

impl Desk {
    /// The window of the `index`th pane.
    fn surface(&mut self, index: usize) -> Option<&mut Surface> {
        self.panes.get_mut(index)?.open.as_mut()
    }
}

impl Dispatch<WlRegistry, GlobalListContents> for Desk {
    fn event(
        desk: &mut Self,
        registry: &WlRegistry,
        event: wl_registry::Event,
        _: &GlobalListContents,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        match event {
            wl_registry::Event::Global { name, interface, version } if interface == "wl_output" => {
                desk.add_screen(registry, name, version);
            }
            wl_registry::Event::GlobalRemove { name } => desk.remove_screen(name),
            _ => {}
        }
    }
}

impl Dispatch<WlOutput, u32> for Desk {
    fn event(
        desk: &mut Self,
        _: &WlOutput,
        event: wl_output::Event,
        global: &u32,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        if let Some(screen) = desk.screens.iter_mut().find(|screen| screen.global == *global) {
            desk.has_moved |= screen.take(event);
        }
    }
}

impl Dispatch<ZxdgOutputV1, u32> for Desk {
    fn event(
        desk: &mut Self,
        _: &ZxdgOutputV1,
        event: zxdg_output_v1::Event,
        global: &u32,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        let screen = desk.screens.iter_mut().find(|screen| screen.global == *global);
        if let (zxdg_output_v1::Event::LogicalPosition { x, y }, Some(screen)) = (event, screen) {
            screen.place(x, y);
        }
    }
}

impl Dispatch<XdgWmBase, ()> for Desk {
    fn event(
        _: &mut Self,
        base: &XdgWmBase,
        event: xdg_wm_base::Event,
        (): &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        if let xdg_wm_base::Event::Ping { serial } = event {
            base.pong(serial);
        }
    }
}

impl Dispatch<XdgSurface, usize> for Desk {
    fn event(
        desk: &mut Self,
        _: &XdgSurface,
        event: xdg_surface::Event,
        &index: &usize,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        let Self { globals, panes, failure, .. } = desk;
        let surface = panes.get_mut(index).and_then(|pane| pane.open.as_mut());
        if let (xdg_surface::Event::Configure { serial }, Some(surface)) = (event, surface) {
            *failure = surface.configure(globals, serial).err().or(failure.take());
        }
    }
}

impl Dispatch<XdgToplevel, usize> for Desk {
    fn event(
        desk: &mut Self,
        _: &XdgToplevel,
        event: xdg_toplevel::Event,
        &index: &usize,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        match event {
            xdg_toplevel::Event::Configure { width, height, .. } => {
                desk.surface(index).into_iter().for_each(|surface| surface.told = Some([width, height]));
            }
            xdg_toplevel::Event::Close => {
                desk.panes.get_mut(index).into_iter().for_each(|pane| pane.is_closed = true);
                desk.has_moved = true;
            }
            _ => {}
        }
    }
}

impl Dispatch<WlBuffer, usize> for Desk {
    fn event(
        desk: &mut Self,
        buffer: &WlBuffer,
        event: wl_buffer::Event,
        &index: &usize,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        if let (wl_buffer::Event::Release, Some(surface)) = (event, desk.surface(index)) {
            surface.done_with(buffer);
        }
    }
}

impl Dispatch<WpPresentationFeedback, (usize, u32)> for Desk {
    fn event(
        desk: &mut Self,
        _: &WpPresentationFeedback,
        event: wp_presentation_feedback::Event,
        &(index, serial): &(usize, u32),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        use wp_presentation_feedback::Event::{Discarded, Presented};
        desk.tells |= matches!(event, Presented { .. });
        if let (Presented { .. } | Discarded, Some(surface)) = (event, desk.surface(index)) {
            surface.shown(serial);
        }
    }
}

impl Dispatch<WlCallback, (usize, u32)> for Desk {
    /// It is a good time for another picture: this one is on its way to the output, where nothing better is ever told.
    fn event(
        desk: &mut Self,
        _: &WlCallback,
        _: wl_callback::Event,
        &(index, serial): &(usize, u32),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        if !desk.tells {
            desk.surface(index).into_iter().for_each(|surface| surface.shown(serial));
        }
    }
}

impl Dispatch<WlSeat, ()> for Desk {
    fn event(
        _: &mut Self,
        seat: &WlSeat,
        event: wl_seat::Event,
        (): &(),
        _: &Connection,
        queue: &QueueHandle<Self>,
    ) {
        if let wl_seat::Event::Capabilities { capabilities: WEnum::Value(capabilities) } = event
            && capabilities.contains(Capability::Pointer)
        {
            seat.get_pointer(queue, ());
        }
    }
}

impl Dispatch<WlPointer, ()> for Desk {
    fn event(
        _: &mut Self,
        pointer: &WlPointer,
        event: wl_pointer::Event,
        (): &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        if let wl_pointer::Event::Enter { serial, .. } = event {
            pointer.set_cursor(serial, None, 0, 0);
        }
    }
}
