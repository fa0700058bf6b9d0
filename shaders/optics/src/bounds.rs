//! Bounds on the numbers of the optical model.

/// A number that is out of its bounds.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{name} is {value:?}; it must be {expected}")]
pub struct OutOfBounds {
    /// Which number: its key in scene files.
    pub name: &'static str,
    /// What it is.
    pub value: f64,
    /// What it must be.
    pub expected: &'static str,
}

/// An error where the number called `name` does not hold.
pub(super) fn held(
    holds: bool,
    name: &'static str,
    value: f64,
    expected: &'static str,
) -> Result<(), OutOfBounds> {
    if holds { Ok(()) } else { Err(OutOfBounds { name, value, expected }) }
}
