//! Windows that show pictures, and what people do in them.
//!
//! | file | what it is |
//! | --- | --- |
//! | `app`, `window`, `picture`, `act`, `keys` | one window on a desktop, with the mouse and keys of whoever is at it |
//! | `outputs`, `edid` | the video outputs of an X server |
//! | `wall` | a window on each output that a back-end's projectors are wired to |
//!
//! A window system wants a desktop's windows in the main thread. So [`open`] gives a [`WindowLoop`], which the main thread
//! runs until the show is over, and for other threads a [`Window`] to show pictures with, and the [`Acts`] of whoever is at
//! it. A [`OutputWall`] takes no input and lives in any thread.

mod act;
mod app;
mod edid;
mod error;
mod keys;
mod outputs;
mod picture;
mod wall;
mod window;

pub use act::{Act, Button};
pub use error::ScreenError;
pub use outputs::{Mode, OutputInfo, Rectangle, outputs};
pub use picture::Picture;
pub use wall::OutputWall;
pub use window::{Acts, Window, WindowLoop, open};
