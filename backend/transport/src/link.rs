//! The two ends of a connection between the front-end and its back-ends.

use protocol::wire::WireError;
use protocol::{FromBackend, FromFrontend};
use std::time::Duration;

/// The silence of a front-end whose end is seen at once: none is too long.
pub(crate) const WITHOUT_END: Duration = Duration::from_secs(u32::MAX as u64);

/// Why a message was not delivered.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// Nothing came in the time allowed; the link still works.
    #[error("no message came in time")]
    Silent,
    /// A back-end is gone.
    #[error("back-end {backend} ended: {how}")]
    Ended {
        /// Which, from 0.
        backend: usize,
        /// What is known of it.
        how: String,
    },
    /// The front-end is gone.
    #[error("the front-end ended: {0}")]
    FrontendEnded(String),
    /// What came from a back-end is not a message.
    #[error("back-end {backend} cannot be understood: {error}")]
    Garbled {
        /// Which, from 0.
        backend: usize,
        /// What is wrong with the bytes.
        error: WireError,
    },
    /// A message cannot be encoded, or bytes from the front-end cannot be decoded.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// The programs were started in a way that cannot work: a sentence that says how to start them.
    #[error("{0}")]
    Launch(String),
}

/// The front-end's end.
pub trait Link {
    /// How many back-ends there are.
    fn backends(&self) -> usize;

    /// A back-end's name with where it runs: `back-end 2 (rank 3, process 4711 on host nodeA)`.
    fn name(&self, backend: usize) -> String;

    /// Sends to one back-end. Returns before the message has arrived.
    fn send(&mut self, backend: usize, message: &FromFrontend) -> Result<(), LinkError>;

    /// Sends the same to all; returns before the messages have arrived.
    fn broadcast(&mut self, message: &FromFrontend) -> Result<(), LinkError>;

    /// The next message of any back-end. [`LinkError::Silent`] when none comes within `timeout`.
    fn receive(&mut self, timeout: Duration) -> Result<(usize, FromBackend), LinkError>;

    /// Whether all ends have had no work for long, so that the next message may be heard some milliseconds late: who wants
    /// to know when it was heard sends another before it.
    fn is_at_rest(&self) -> bool {
        false
    }

    /// Notes what the run is doing ("drawing frame 3"), for the sentence said when the launcher ends it.
    fn set_activity(&mut self, activity: &str);

    /// Starts a back-end again that has ended; false where that cannot be done. It says hello as it did at first.
    ///
    /// # Errors
    /// It can be done, and did not work.
    fn revive(&mut self, backend: usize) -> Result<bool, LinkError>;

    /// Takes leave of back-ends that were asked to quit; nothing travels after it.
    fn finish(&mut self) -> Result<(), LinkError>;
}

/// A back-end's end.
pub trait WorkerLink {
    /// Sends to the front-end; returns when the message is on its way and its memory free.
    fn send(&mut self, message: FromBackend) -> Result<(), LinkError>;

    /// The next message of the front-end. [`LinkError::Silent`] when none comes within `timeout`.
    fn receive(&mut self, timeout: Duration) -> Result<FromFrontend, LinkError>;

    /// How long the front-end may say nothing before it counts as lost.
    fn frontend_silence(&self) -> Duration;

    /// Whether another takes this back-end's place if it fails: then one that is stuck had better.
    fn can_be_replaced(&self) -> bool {
        false
    }
}
