//! Windows that show pictures, and what people do in them.
//!
//! A window system wants its windows in the main thread. So [`open`] gives a [`WindowLoop`], which the main thread runs
//! until the show is over, and for other threads a [`Window`] to show pictures with, and the [`Acts`] of whoever is at it.

mod act;
mod app;
mod error;
mod keys;
mod picture;
mod window;

pub use act::{Act, Button};
pub use error::ScreenError;
pub use picture::Picture;
pub use window::{Acts, Window, WindowLoop, open};
