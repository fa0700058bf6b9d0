//! Why there is no window.

/// A sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScreenError {
    /// There is no window system, or it does not answer.
    #[error("no window can be opened: {0}; start it where there is a desktop, or take --output none")]
    NoWindowSystem(String),
    /// A window was opened and cannot be used.
    #[error("the window cannot show anything: {0}")]
    Window(String),
}
