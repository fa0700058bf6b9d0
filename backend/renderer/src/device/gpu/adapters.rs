//! The adapters that this host's drivers offer, asked for once.

use crate::device::DeviceError;
use crate::device::adapter::{AdapterKind, ChosenAdapter, OfferedAdapter, choose_adapter};
use protocol::AdapterWish;
use std::sync::OnceLock;

static INSTANCE: OnceLock<wgpu::Instance> = OnceLock::new();
static ADAPTERS: OnceLock<Vec<wgpu::Adapter>> = OnceLock::new();

/// What the drivers are asked through.
pub(super) fn instance() -> &'static wgpu::Instance {
    INSTANCE.get_or_init(|| {
        let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle();
        wanted.backends = wgpu::Backends::PRIMARY;
        wgpu::Instance::new(wanted)
    })
}

fn adapters() -> &'static [wgpu::Adapter] {
    ADAPTERS.get_or_init(|| pollster::block_on(instance().enumerate_adapters(wgpu::Backends::PRIMARY)))
}

/// The adapter for a back-end.
pub(super) fn choose(wish: &AdapterWish) -> Result<ChosenAdapter, DeviceError> {
    let offered: Vec<_> = adapters().iter().map(|adapter| offer(adapter.get_info())).collect();
    choose_adapter(&offered, wish).map_err(DeviceError)
}

/// The adapter at a place of the list that [`choose`] chooses from.
pub(super) fn adapter(index: usize) -> &'static wgpu::Adapter {
    &adapters()[index]
}

fn offer(info: wgpu::AdapterInfo) -> OfferedAdapter {
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => AdapterKind::Discrete,
        wgpu::DeviceType::IntegratedGpu => AdapterKind::Integrated,
        wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other => AdapterKind::Other,
        wgpu::DeviceType::Cpu => AdapterKind::Software,
    };
    OfferedAdapter { name: info.name, kind, bus: info.device_pci_bus_id }
}
