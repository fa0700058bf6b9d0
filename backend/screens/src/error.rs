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
    #[error(
        "no X server can be reached ({0}); start this where DISPLAY names one that may be used, or WAYLAND_DISPLAY a desktop"
    )]
    NoServer(String),
    /// There is no Wayland desktop, or it does not answer.
    #[error(
        "no Wayland desktop can be reached ({0}); start this where WAYLAND_DISPLAY names one, or unset it where DISPLAY names an X server"
    )]
    NoDesktop(String),
    /// The Wayland desktop lacks something.
    #[error("the Wayland desktop has no {what}; {advice}")]
    Desktop {
        /// What it lacks.
        what: String,
        /// What to do.
        advice: &'static str,
    },
    /// The Wayland desktop went away, or refuses something.
    #[error("the Wayland desktop ended or refused to go on: {0}")]
    DesktopEnded(String),
    /// A projector has a place on the desktop, and Wayland gives windows none.
    #[error("projector `{0}` has a place on the desktop, which Wayland gives to no window; name its output")]
    NoPlace(String),
    /// Pictures for windows take more memory than there is.
    #[error("there is no room for pictures to show: {0}; see how much is free in XDG_RUNTIME_DIR")]
    NoRoom(String),
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
        "none of the outputs {wanted} is connected to {server}; `lightloom outputs` lists those that are"
    )]
    NoOutput {
        /// Those that the display file names.
        wanted: String,
        /// Which X server or desktop.
        server: String,
    },
    /// A GPU does not paint the windows of a back-end.
    #[error("{0}")]
    Painting(String),
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

impl From<wayland_client::DispatchError> for ScreenError {
    fn from(error: wayland_client::DispatchError) -> Self {
        Self::DesktopEnded(error.to_string())
    }
}

impl From<wayland_client::backend::WaylandError> for ScreenError {
    fn from(error: wayland_client::backend::WaylandError) -> Self {
        Self::DesktopEnded(error.to_string())
    }
}

impl From<ScreenError> for WallError {
    fn from(error: ScreenError) -> Self {
        Self(error.to_string())
    }
}
