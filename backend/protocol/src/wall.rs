//! What shows pictures to people.

use crate::ScreenImage;

/// Why nothing can be shown any more: one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct WallError(pub String);

/// The windows of a back-end, on the outputs of its projectors.
pub trait Wall: Send {
    /// Readies the pictures of the frame to be shown next, out of sight. A projector without one keeps what it shows.
    ///
    /// # Errors
    /// Nothing can be shown any more.
    fn ready(&mut self, images: &[ScreenImage]) -> Result<(), WallError>;

    /// Shows what is ready, in all windows at once, and returns when the window system has done so.
    ///
    /// # Errors
    /// Nothing can be shown any more.
    fn show(&mut self) -> Result<(), WallError>;

    /// Looks after the windows: says in sentences what has happened to them and to their outputs.
    ///
    /// # Errors
    /// Nothing can be shown any more.
    fn tend(&mut self) -> Result<Vec<String>, WallError>;
}
