//! The wgpu device. The only folder that names wgpu.

mod adapters;
mod arena;
mod atlas;
mod bands;
mod batch;
mod bind;
mod cache_file;
mod cast;
mod cast_short;
mod context;
mod device;
mod feedback;
mod finish;
mod kept;
mod kernels;
mod layers;
mod mend;
mod pass;
mod pictures;
mod pipeline_cache;
mod plane_buffers;
mod planes;
mod precision;
mod present;
mod readback;
mod show;
mod storage;
mod swapchain;
mod view;

pub(super) use context::context;
pub use device::GpuDevice;
pub use swapchain::{Swapchain, Swapchains};
