//! Files that people write: how they are read, and how their mistakes are told.

mod brief;
mod list;
mod nearest;
mod read;

pub use brief::{brief_number, brief_text};
pub use list::ListOf;
pub use nearest::{did_you_mean, with_suggestion};
pub use read::{read_bytes, read_text};
