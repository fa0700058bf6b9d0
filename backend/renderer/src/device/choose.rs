//! Which device: the one asked for, or the best available.

use super::{CpuDevice, Device, DeviceError};
use crate::cache_size::slots_within;
use protocol::{AdapterWish, DeviceChoice, DeviceInfo, FilterChoice};

/// A device, and what to say of it.
#[derive(Debug)]
pub struct ChosenDevice {
    /// The device.
    pub device: Device,
    /// Its name, and why it was taken.
    pub info: DeviceInfo,
}

/// The brick cache that a device is opened with.
#[derive(Clone, Copy, Debug)]
pub struct CacheWish {
    /// It takes no more memory.
    pub bytes: u64,
    /// It holds no more bricks: the volume has no more.
    pub slots_needed: u64,
    /// Whether bricks have standard deviations.
    pub has_deviations: bool,
}

impl CacheWish {
    /// Slots of bricks whose samples take so many bytes each.
    fn slots(&self, slots_needed: u64, sample_bytes: u64) -> u32 {
        slots_within(self.bytes, self.brick_bytes(sample_bytes), slots_needed)
    }

    /// Bytes of a brick whose samples take so many.
    fn brick_bytes(&self, sample_bytes: u64) -> u64 {
        sample_bytes + if self.has_deviations { bricks::BRICK_VOXELS as u64 } else { 0 }
    }
}

/// Opens the device of choice, by default a GPU where there is one that is no driver in software, with such a brick
/// cache. A GPU that the display file names is taken whatever it is.
///
/// # Errors
/// A GPU was asked for and there is none, or none of that name, or its memory does not hold the cache.
pub fn open_device(
    choice: DeviceChoice,
    adapter: &AdapterWish,
    filter: FilterChoice,
    cache: &CacheWish,
) -> Result<ChosenDevice, DeviceError> {
    let cpu = |reason: &str| {
        let slots = cache.slots(cache.slots_needed, CPU_BRICK_BYTES);
        let info = DeviceInfo {
            adapter: format!("cpu: {} threads", rayon::current_num_threads()),
            reason: reason.into(),
            filter: "exact".into(),
            cache_bytes: u64::from(slots) * cache.brick_bytes(CPU_BRICK_BYTES),
        };
        Ok(ChosenDevice { device: Device::Cpu(Box::new(CpuDevice::new(slots, cache.has_deviations))), info })
    };
    let gpu = || open_gpu(adapter, filter, cache);
    match (choice, &adapter.name) {
        (DeviceChoice::Cpu, _) => cpu("it was asked for"),
        (DeviceChoice::Auto, None) => match software_gpu(adapter) {
            Some(name) => cpu(&format!("the only adapter, {name}, draws on this processor, too, and slower")),
            None => gpu().or_else(|error| cpu(&error.0)),
        },
        (_, Some(_)) => gpu().map_err(|error| DeviceError(format!("{error}, or take --device cpu"))),
        (DeviceChoice::Gpu, None) => {
            gpu().map_err(|error| DeviceError(format!("{error}; take --device cpu, or {INSTEAD}")))
        }
    }
}

/// What else helps where there is no GPU.
const INSTEAD: &str =
    if cfg!(feature = "gpu") { "install a Vulkan driver" } else { "build it with that feature" };

/// Bytes of a brick in the CPU device's cache.
const CPU_BRICK_BYTES: u64 = 2 * bricks::BRICK_VOXELS as u64;

#[cfg(feature = "gpu")]
fn open_gpu(
    adapter: &AdapterWish,
    filter: FilterChoice,
    cache: &CacheWish,
) -> Result<ChosenDevice, DeviceError> {
    let (context, why) = super::gpu::context(adapter)?;
    // A power of two, the larger one where the cache allows it.
    let brick_bytes = context.brick_bytes();
    let slots = cache.slots(cache.slots_needed, brick_bytes).next_power_of_two();
    let most = cache.slots(u64::MAX, brick_bytes).max(16);
    let slots = if slots > most { slots / 2 } else { slots };
    let device = super::gpu::GpuDevice::new(context, filter, slots, cache.has_deviations)?;
    let info = device.info(&why);
    Ok(ChosenDevice { device: Device::Gpu(Box::new(device)), info })
}

#[cfg(feature = "gpu")]
fn software_gpu(adapter: &AdapterWish) -> Option<String> {
    let (context, _) = super::gpu::context(adapter).ok()?;
    context.software_name().map(str::to_owned)
}

#[cfg(not(feature = "gpu"))]
fn software_gpu(_: &AdapterWish) -> Option<String> {
    None
}

#[cfg(not(feature = "gpu"))]
fn open_gpu(_: &AdapterWish, _: FilterChoice, _: &CacheWish) -> Result<ChosenDevice, DeviceError> {
    Err(DeviceError("this program was built without its gpu feature".into()))
}
