//! The wgpu device. The only folder that names wgpu.

mod atlas;
mod cache_file;
mod context;
mod device;
mod feedback;
mod kernels;
mod pipeline_cache;
mod precision;
mod readback;
mod storage;
mod view;

pub use context::adapter_name;
pub(super) use context::{brick_bytes, software_adapter};
pub use device::GpuDevice;
