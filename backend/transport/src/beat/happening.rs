//! What happens while a display is driven.

use protocol::{FrameReport, ScreenImage};
use std::time::Duration;

/// What happens while a display is driven.
#[derive(Clone, Debug, PartialEq)]
pub enum Happening {
    /// A frame is due: hand it over with [`super::Drive::draw`].
    Due {
        /// Its number.
        frame: u32,
        /// When it will be seen, on the display's clock.
        seen_at: Duration,
    },
    /// What screens will show of the frame that the back-end draws.
    Screen {
        /// The back-end.
        backend: usize,
        /// The picture.
        image: ScreenImage,
    },
    /// A back-end has drawn a frame.
    Drawn {
        /// The back-end.
        backend: usize,
        /// Its account.
        report: Box<FrameReport>,
    },
    /// A frame of a controlled display is drawn by all that are waited for: say with [`super::Drive::decide`] whether it is
    /// shown.
    Finished {
        /// Its number.
        frame: u32,
    },
    /// All are told to show a frame.
    Ordered {
        /// Its number.
        frame: u32,
        /// When, on the display's clock.
        at: Duration,
    },
    /// A back-end shows a frame.
    Shown {
        /// The back-end.
        backend: usize,
        /// Its number.
        frame: u32,
        /// Since when, on the display's clock, as well as it is known.
        at: Duration,
        /// How long it was away, if this is its first frame since it was lost.
        away: Option<Duration>,
    },
    /// Something has happened at a back-end, and the show goes on.
    Said {
        /// The back-end.
        backend: usize,
        /// A sentence.
        sentence: String,
    },
    /// A back-end cannot go on; the others do, and it is started again.
    Lost {
        /// The back-end.
        backend: usize,
        /// A sentence.
        why: String,
    },
    /// A back-end lives, and has drawn nothing for long.
    Standstill {
        /// The back-end.
        backend: usize,
        /// For how long.
        time: Duration,
    },
    /// Somebody asked the run to end.
    Stopped,
}
