//! Cubics fitted to a function.

use super::Cubic;

/// A piece is bisected at most this often: a jump is then 2⁻³² of the stretch wide.
pub const MOST_BISECTIONS: u32 = 32;
/// How much looser the gradient is fitted than the value: it only shades.
pub const GRADIENT_SLACK: f64 = 100.0;

/// Cubics through N functions, with the largest miss between their points.
pub struct Fit<const N: usize> {
    /// The cubics.
    pub cubics: [Cubic; N],
    /// The largest miss.
    pub error: f64,
}

impl<const N: usize> Fit<N> {
    /// Through the values of `f` on [0, 1].
    pub fn new(f: impl Fn(f64) -> [f64; N]) -> Self {
        let thirds = [f(0.0), f(1.0 / 3.0), f(2.0 / 3.0), f(1.0)];
        let cubics: [Cubic; N] =
            std::array::from_fn(|i| Cubic::through_thirds(thirds.map(|values| values[i])));
        let mut error: f64 = 0.0;
        for u in [1.0 / 8.0, 0.45, 7.0 / 8.0] {
            let exact = f(u);
            for (cubic, exact) in cubics.iter().zip(exact) {
                error = error.max((cubic.at(u) - exact).abs());
            }
        }
        Self { cubics, error }
    }
}
