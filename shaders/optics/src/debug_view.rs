//! What a debug view shows, and on which scale.

use serde::{Deserialize, Serialize};

/// A view of the working set instead of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DebugView {
    /// Levels above the finest that the light comes from.
    Lod,
    /// Levels that the node is too coarse by; 0 if it is fine enough.
    Deficit,
    /// Samples of each ray.
    Samples,
    /// Share of the node's own samples, its parent's being the rest.
    Weights,
}

/// Blue and yellow on the scale of colours: views of nodes are drawn in the scene's own opacities over black, so that
/// black is left for where nothing is.
const BLUE_TO_YELLOW: (f64, f64) = (0.2, 0.8);

impl DebugView {
    /// All there are.
    pub const ALL: [Self; 4] = [Self::Lod, Self::Deficit, Self::Samples, Self::Weights];

    /// The values at the ends of the scale; what lies beyond has the colour of the end.
    pub fn scale(self) -> (f64, f64) {
        match self {
            // Few displays see more than three levels of a volume at once; each is a colour of its own.
            Self::Lod | Self::Deficit => (0.0, 4.0),
            Self::Samples => (0.0, 1024.0),
            Self::Weights => (0.0, 1.0),
        }
    }

    /// The part of the colours that the scale has.
    pub fn colours(self) -> (f64, f64) {
        match self {
            Self::Samples => (0.0, 1.0),
            Self::Lod | Self::Deficit | Self::Weights => BLUE_TO_YELLOW,
        }
    }

    /// Where a value lies on the scale, 0 to 1: counts of samples by their logarithm.
    pub fn place(self, value: f64) -> f64 {
        let (least, most) = self.scale();
        let share = match self {
            Self::Samples => (1.0 + value.max(0.0)).log2() / (1.0 + most).log2(),
            Self::Lod | Self::Deficit | Self::Weights => (value - least) / (most - least),
        };
        share.clamp(0.0, 1.0)
    }
}

/// The colours between which the map goes straight on in linear RGB, at equal distances. They are of our own choosing:
/// the CIE lightness L* of each is 22 above that of the one before (0, 22, 44, 66, 88, 100), so that what is more is
/// lighter, in print without colour, too; and the hue goes from blue over red to yellow, the way of things that glow.
const KNOTS: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [0.0, 0.005, 0.437],
    [0.46, 0.015, 0.414],
    [1.0, 0.18, 0.17],
    [1.0, 0.71, 0.005],
    [1.0, 1.0, 1.0],
];

/// The five ramps of the heat map, each from one of its colours to the next; the first begins at black.
pub fn heat_ramps() -> [[f64; 3]; 5] {
    std::array::from_fn(|i| std::array::from_fn(|c| KNOTS[i + 1][c] - KNOTS[i][c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_a_scale_are_its_ends() {
        for view in DebugView::ALL {
            let (least, most) = view.scale();
            assert_eq!([least - 1.0, least, most, 2.0 * most].map(|v| view.place(v)), [0.0, 0.0, 1.0, 1.0]);
            assert!(view.place(0.5 * most) > 0.1 && view.place(0.5 * most) < 0.95);
        }
    }
}
