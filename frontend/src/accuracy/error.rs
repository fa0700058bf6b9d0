//! Why accuracy cannot be measured.

/// Each is one sentence for the person who started the program.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AccuracyError {
    /// The scene has no such frame.
    #[error("--frame {frame} lies outside the scene's frames 0..{count}; give one of them")]
    Frame {
        /// The frame asked for.
        frame: u32,
        /// How many there are.
        count: u32,
    },
    /// The display has no such projector.
    #[error(
        "--projectors: {projector} is not one of the display's {count} projectors; give numbers from 0 to {}",
        count - 1
    )]
    Projector {
        /// The projector asked for.
        projector: u32,
        /// How many there are.
        count: usize,
    },
    /// A projector is named twice.
    #[error("--projectors names {0} twice; give each projector once")]
    Twice(u32),
    /// The stride leaves no pixel.
    #[error("--stride {0} leaves no pixel of these projectors; give a smaller one")]
    Stride(u32),
    /// The truth is black.
    #[error(
        "none of the {rays} rays of projectors {projectors:?} meets anything that is visible; give others with --projectors"
    )]
    Black {
        /// How many rays.
        rays: usize,
        /// Of which projectors.
        projectors: Vec<u32>,
    },
    /// The reference or the device cannot go on; the sentence is its own.
    #[error("{0}")]
    Backend(String),
    /// A signal ended the work.
    #[error("stopped: nothing was written")]
    Stopped,
}
