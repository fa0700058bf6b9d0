//! Why there is no window.

use protocol::WallError;
use x11rb::errors::{ConnectionError, ReplyError, ReplyOrIdError};

/// A sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScreenError {
    /// There is no window system, or it does not answer.
    #[error("no window can be opened: {0}; start it where there is a desktop, or take --output none")]
    NoWindowSystem(String),
    /// There is no X server, or it does not answer.
    #[error("no X server can be reached ({0}); start this where DISPLAY names one, and may be used")]
    NoServer(String),
    /// The X server lacks something.
    #[error("the X server has no {what}; {advice}")]
    Server {
        /// What it lacks.
        what: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// The X server went away, or refuses something.
    #[error("the X server ended or refused to go on: {0}")]
    Connection(String),
    /// No window of a back-end can be opened.
    #[error(
        "none of the outputs {wanted} is connected to the X server {server}; `lightloom outputs` lists those that are"
    )]
    NoOutput {
        /// Those that the display file names.
        wanted: String,
        /// Its name.
        server: String,
    },
    /// A window was opened and cannot be used.
    #[error("the window cannot show anything: {0}")]
    Window(String),
}

impl From<ConnectionError> for ScreenError {
    fn from(error: ConnectionError) -> Self {
        Self::Connection(error.to_string())
    }
}

impl From<ReplyError> for ScreenError {
    fn from(error: ReplyError) -> Self {
        Self::Connection(error.to_string())
    }
}

impl From<ReplyOrIdError> for ScreenError {
    fn from(error: ReplyOrIdError) -> Self {
        Self::Connection(error.to_string())
    }
}

impl From<ScreenError> for WallError {
    fn from(error: ScreenError) -> Self {
        Self(error.to_string())
    }
}
