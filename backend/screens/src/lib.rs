//! Windows that show pictures, and what people do in them.
//!
//! | file | what it is |
//! | --- | --- |
//! | `app`, `window`, `picture`, `act`, `keys` | one window on a desktop, with the mouse and keys of whoever is at it |
//! | `output` | what is known of a video output |
//! | `wall` | a window on each output that a back-end's projectors are wired to, on X or Wayland |
//!
//! A window system wants a desktop's windows in the main thread. So [`open`] gives a [`WindowLoop`], which the main thread
//! runs until the show is over, and for other threads a [`Window`] to show pictures with, and the [`Acts`] of whoever is at
//! it. The wall of [`open_wall`] takes no input and lives in any thread.

mod act;
mod app;
mod error;
mod keys;
mod output;
mod picture;
mod wall;
mod window;

pub use act::{Act, Button};
pub use error::ScreenError;
pub use output::{Mode, OutputInfo, Rectangle};
pub use picture::Picture;
pub use wall::{NativeWindow, OutputWall, Painter, open_wall, outputs};
pub use window::{Acts, Window, WindowLoop, open};
