//! A named band of data values.

use optics::{Trapezoid, TrapezoidError};

/// A trapezoid over data values that enhancers and keyframes know by its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Its name, unlike any other band's.
    pub name: String,
    /// Its corners, data values.
    pub values: Trapezoid,
}

/// A trapezoid over data values as one over s.
pub(super) fn normalised_band(
    values: Trapezoid,
    (low, high): (f64, f64),
) -> Result<Trapezoid, TrapezoidError> {
    Trapezoid::new(values.corners().map(|value| (value - low) / (high - low)))
}
