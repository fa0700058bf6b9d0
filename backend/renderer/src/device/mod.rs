//! What casts rays: the GPU, or the kernels' twin on the CPU.

#[cfg(any(feature = "gpu", test))]
mod adapter;
mod choose;
mod cpu;
mod either;
mod error;
#[cfg(feature = "gpu")]
pub mod gpu;
mod job;
mod mend;
mod rows;
mod show;
mod tag;
mod tile_list;
mod tiles;
mod under_way;

pub use choose::{CacheWish, ChosenDevice, open_device};
pub use cpu::CpuDevice;
pub use either::Device;
pub use error::DeviceError;
pub use job::{
    CastJob, CastOutcome, Gather, NEVER, Part, Patch, Sharing, ShortJob, ShortView, TileGrid, coarse,
};
pub use show::{Codes, DevicePicture, FinishJob, ShowJob};
pub use tag::{FeedbackTag, TaggedFeedback};
pub use tile_list::TileList;
