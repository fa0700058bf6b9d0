//! How the stage of a world becomes frames: its scenes, its tools, and what is drawn of these.
//!
//! | file | what it is |
//! | --- | --- |
//! | `piece` | a scene that is ready to be shown, in all its looks |
//! | `carried` | what tools carry |
//! | `marks` | what is drawn of tools, and written |
//! | `menu` | what is drawn of menus that are open |
//! | `theatre` | a world with its pieces: things that happen in, frames out |
//! | `check_number` | whether two frames are the same |

mod carried;
mod check_number;
mod marks;
mod menu;
mod piece;
mod theatre;

pub use carried::{carries, needs_band};
pub use check_number::check_number;
pub use menu::menu_size;
pub use piece::{Looks, Piece};
pub use theatre::{Ensemble, Theatre};
