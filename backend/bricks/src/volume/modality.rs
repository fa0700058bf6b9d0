//! What a volume was taken by.

use std::fmt;

/// What a volume was taken by, where its file says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Modality {
    /// Nothing is said of it.
    #[default]
    Unknown,
    /// X-ray computed tomography: values are Hounsfield units.
    Ct,
    /// Magnetic resonance: values have no unit.
    Mr,
}

impl fmt::Display for Modality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Modality::Unknown => "unknown",
            Modality::Ct => "CT",
            Modality::Mr => "MR",
        })
    }
}
