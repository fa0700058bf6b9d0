//! The wgpu device. The only folder that names wgpu.

mod adapters;
mod atlas;
mod batch;
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

pub(super) use context::context;
pub use device::GpuDevice;
