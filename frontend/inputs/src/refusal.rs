//! Why something that arrived is not taken.

use serde::{Deserialize, Serialize};

/// Each is a clause that follows "refused:".
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, thiserror::Error, Serialize, Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    /// It ends too early.
    #[error("it is cut short")]
    Short,
    /// It is longer than its format allows.
    #[error("it is too long")]
    Long,
    /// It is not of this protocol.
    #[error("it is of another protocol or version")]
    Foreign,
    /// What it says of itself does not hold.
    #[error("its checksum is wrong")]
    Checksum,
    /// Its form is not that of its protocol.
    #[error("it does not have the form of its protocol")]
    Form,
    /// A name or an address that nothing here stands for.
    #[error("its address or name is unknown")]
    Unknown,
    /// A part of a longer message whose other parts did not arrive.
    #[error("a part of it was lost on the way")]
    Gap,
    /// The number of a sensor, button or axis is out of bounds.
    #[error("the number of its sensor, button or axis is out of bounds")]
    Index,
    /// NaN or an infinite number.
    #[error("it has an infinite number or NaN")]
    NotFinite,
    /// A position beyond any tracker.
    #[error("its position is farther than 1000 km")]
    TooFar,
    /// A quaternion of no length, or of a length far from 1.
    #[error("its quaternion has no length, or not 1")]
    NoQuaternion,
    /// A matrix that does not rotate.
    #[error("its matrix is no rotation")]
    NoRotation,
}
