//! What a volume is before it is a store: its description, its numbers, and its slabs one after the other.

mod element;
mod error;
mod frame;
mod input;
mod modality;
mod reader;
mod samples;

pub use element::{ByteOrder, Element};
pub use error::VolumeError;
pub use frame::{Space, VolumeFrame};
pub use input::open_file;
pub use modality::Modality;
pub use reader::{MAX_EDGE_VOXELS, VolumeInfo, VolumeReader};
pub(crate) use samples::with_samples;
pub use samples::{Sample, Samples};
