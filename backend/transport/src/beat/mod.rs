//! The beat of a driven display: the life of a frame from the front-end's clock to every screen.

mod asking;
mod attendance;
mod clocks;
mod drive;
mod happening;
mod rhythm;
mod showing;
mod stage;
mod time;

pub use drive::Drive;
pub use happening::Happening;
pub(crate) use showing::{ShowThread, Told, now_us};
pub use time::Time;
