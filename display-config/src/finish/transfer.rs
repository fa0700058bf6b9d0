//! From linear light to the codes that a projector makes it of.

use serde::{Deserialize, Serialize};

/// A projector's curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Transfer {
    /// That of IEC 61966-2-1.
    #[default]
    Srgb,
    /// A power: light is (code / 255)^γ.
    Gamma(f64),
    /// As measured: red, green, blue.
    Measured(Box<[Response; 3]>),
}

/// The light that one channel of a projector makes of a code, measured at some codes and linear between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Response {
    knots: Vec<(f64, u8)>,
}

impl Response {
    /// From pairs of light, in units of a picture's 1, and code; both rise from pair to pair. None where they do not, or
    /// where there are fewer than two.
    pub fn new(knots: Vec<(f64, u8)>) -> Option<Self> {
        let rises = |pair: &[(f64, u8)]| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1;
        let is_light = |&(light, _): &(f64, u8)| light.is_finite() && light >= 0.0;
        let is_curve = knots.len() >= 2 && knots.windows(2).all(rises) && knots.iter().all(is_light);
        is_curve.then_some(Self { knots })
    }

    /// The pairs of light and code.
    pub fn knots(&self) -> &[(f64, u8)] {
        &self.knots
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_rising_pairs_are_a_response() {
        assert!(Response::new(vec![(0.0, 0), (1.0, 255)]).is_some());
        for wrong in [
            vec![],
            vec![(0.0, 0)],
            vec![(0.0, 0), (0.0, 255)],
            vec![(0.5, 0), (0.4, 9), (1.0, 255)],
            vec![(0.0, 3), (1.0, 3)],
            vec![(f64::NAN, 0), (1.0, 255)],
            vec![(0.0, 0), (f64::INFINITY, 255)],
            vec![(-0.1, 0), (1.0, 255)],
        ] {
            assert_eq!(Response::new(wrong.clone()), None, "{wrong:?}");
        }
    }
}
