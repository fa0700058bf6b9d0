//! The wgpu device. The only folder that names wgpu.

mod atlas;
mod context;
mod device;
mod kernels;
mod precision;
mod readback;

pub use context::adapter_name;
pub use device::GpuDevice;
