//! What inputs ask for.

use world::{Change, Deed};

/// One thing.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Something happens to the world.
    Deed(Deed),
    /// Somebody wants to know what there is.
    Help,
    /// The show is over.
    Quit,
}

impl From<Change> for Request {
    fn from(change: Change) -> Self {
        Self::Deed(Deed::Change(change))
    }
}
