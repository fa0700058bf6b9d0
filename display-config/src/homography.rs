//! A projective map of the plane.

use glam::{DMat3, DVec2};
use serde::{Deserialize, Serialize};

/// A plane projective map: (x, y, 1) ↦ M (x, y, 1), divided by the third component.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Homography(pub DMat3);

impl Homography {
    /// The image of a point.
    pub fn apply(&self, point: DVec2) -> DVec2 {
        let image = self.0 * point.extend(1.0);
        image.truncate() / image.z
    }
}
