//! Why a session with back-ends cannot go on.

use super::link::LinkError;

/// Why a run cannot go on: a sentence that names the back-end and what to do. The session is over after it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SessionError {
    /// There is not one setup for each back-end.
    #[error(
        "there are {setups} back-ends to set up and {backends} were started; start as many back-ends as the \
         display is assigned to, or assign it again"
    )]
    Count {
        /// Setups given.
        setups: usize,
        /// Back-ends there are.
        backends: usize,
    },
    /// A back-end is gone.
    #[error("{name} ended while {activity}: {how}")]
    Ended {
        /// Its name and place.
        name: String,
        /// What the run was doing.
        activity: String,
        /// What is known of it, and what to do.
        how: String,
    },
    /// A back-end gives no sign of life, and its process has not ended or cannot be asked.
    #[error(
        "{name} has said nothing for {seconds} s while {activity}; see whether its process is stopped or its host \
         is down"
    )]
    Silent {
        /// Its name and place.
        name: String,
        /// What the run was doing.
        activity: String,
        /// How long.
        seconds: u64,
    },
    /// A back-end lives, and its work gets no further.
    #[error(
        "{name} has got no further for {seconds} s while {activity}; see whether its graphics driver or the disk \
         with the volume is stuck"
    )]
    Stuck {
        /// Its name and place.
        name: String,
        /// What the run was doing.
        activity: String,
        /// How long.
        seconds: u64,
    },
    /// Somebody asked the run to end.
    #[error("stopped by a signal while {activity}")]
    Stopped {
        /// What the run was doing.
        activity: String,
    },
    /// A back-end said why it cannot go on.
    #[error("{name} failed while {activity}: {sentence}")]
    Failed {
        /// Its name and place.
        name: String,
        /// What the run was doing.
        activity: String,
        /// What it said.
        sentence: String,
    },
    /// A back-end is of another build, or answers what was not asked.
    #[error(
        "{name} does not fit this front-end: {what}; start lightloom and lightloom-backend from the same build"
    )]
    Misfit {
        /// Its name and place.
        name: String,
        /// What it did.
        what: String,
    },
    /// The connection itself.
    #[error("the connection failed while {activity}: {error}")]
    Link {
        /// What the run was doing.
        activity: String,
        /// Why.
        error: LinkError,
    },
}

impl SessionError {
    /// What went wrong with a link, in words that name the back-end.
    pub(crate) fn of_link(error: LinkError, activity: String, name: impl Fn(usize) -> String) -> Self {
        match error {
            LinkError::Ended { backend, how } => Self::Ended { name: name(backend), activity, how },
            LinkError::Garbled { backend, error } => {
                Self::Misfit { name: name(backend), what: error.to_string() }
            }
            error => Self::Link { activity, error },
        }
    }
}
