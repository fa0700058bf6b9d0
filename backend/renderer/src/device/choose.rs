//! Which device: the one asked for, or the best available.

use super::{CpuDevice, Device, DeviceError};
use protocol::{DeviceChoice, DeviceInfo, FilterChoice};

/// A device, and what to say of it.
#[derive(Debug)]
pub struct ChosenDevice {
    /// The device.
    pub device: Device,
    /// Its name, and why it was taken.
    pub info: DeviceInfo,
}

/// Opens the device of choice, by default a hardware GPU if there is one, with a brick cache of at
/// most `cache_bytes` and at most `slots_needed` bricks.
///
/// # Errors
/// A GPU was asked for and there is none, or its memory does not hold the cache.
pub fn open_device(
    choice: DeviceChoice,
    filter: FilterChoice,
    cache_bytes: u64,
    slots_needed: u64,
) -> Result<ChosenDevice, DeviceError> {
    let cpu = |reason: &str| {
        let slots = slots_within(cache_bytes, CPU_BRICK_BYTES, slots_needed);
        let info = DeviceInfo {
            adapter: format!("cpu: {} threads", rayon::current_num_threads()),
            reason: reason.into(),
            filter: "exact".into(),
            cache_bytes: u64::from(slots) * CPU_BRICK_BYTES,
        };
        Ok(ChosenDevice { device: Device::Cpu(Box::new(CpuDevice::new(slots))), info })
    };
    match (choice, open_gpu(filter, cache_bytes, slots_needed)) {
        (DeviceChoice::Cpu, _) => cpu("it was asked for"),
        (DeviceChoice::Auto, None) => cpu("this program was built without its gpu feature"),
        (DeviceChoice::Gpu, None) => Err(DeviceError(
            "this program was built without its gpu feature; build it with that feature, or take --device cpu".into(),
        )),
        (DeviceChoice::Auto, Some(open)) => match software_gpu() {
            Some(name) => cpu(&format!("the only adapter, {name}, draws on this processor, too, but more slowly")),
            None => open().or_else(|error| cpu(&error.0)),
        },
        (DeviceChoice::Gpu, Some(open)) => open().map_err(|error| {
            DeviceError(format!("{error}; take --device cpu, or install a Vulkan driver"))
        }),
    }
}

/// Slots for the bricks that fit, at least the nine that show a root and its children, and a blank one.
pub(crate) fn slots_within(cache_bytes: u64, brick_bytes: u64, slots_needed: u64) -> u32 {
    slots_needed.min(cache_bytes / brick_bytes).clamp(9, 1 << 20) as u32 + 1
}

/// Bytes of a brick in the CPU device's cache.
const CPU_BRICK_BYTES: u64 = 2 * bricks::BRICK_VOXELS as u64;

type OpenGpu = Box<dyn FnOnce() -> Result<ChosenDevice, DeviceError>>;

#[cfg(feature = "gpu")]
fn open_gpu(filter: FilterChoice, cache_bytes: u64, slots_needed: u64) -> Option<OpenGpu> {
    Some(Box::new(move || {
        // A power of two, the larger one where the cache allows it.
        let brick_bytes = super::gpu::brick_bytes()?;
        let slots = slots_within(cache_bytes, brick_bytes, slots_needed).next_power_of_two();
        let most = slots_within(cache_bytes, brick_bytes, u64::MAX).max(16);
        let device = super::gpu::GpuDevice::open(filter, if slots > most { slots / 2 } else { slots })?;
        let info = device.info();
        Ok(ChosenDevice { device: Device::Gpu(Box::new(device)), info })
    }))
}

#[cfg(feature = "gpu")]
fn software_gpu() -> Option<String> {
    super::gpu::software_adapter()
}

#[cfg(not(feature = "gpu"))]
fn software_gpu() -> Option<String> {
    None
}

#[cfg(not(feature = "gpu"))]
fn open_gpu(_: FilterChoice, _: u64, _: u64) -> Option<OpenGpu> {
    None
}
