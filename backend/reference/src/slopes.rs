//! The scalar's gradients along a piece.

use super::Cubic;
use super::field::Levels;
use glam::{DMat3, DVec3};

/// The matrix from gradients of the data value per finest voxel (volume frame) to those of the scalar per finest voxel's
/// edge `voxel_m` (display frame), for a domain `domain_width` data values wide.
pub fn shading_from_gradient(volume_from_display: DMat3, voxel_m: f64, domain_width: f64) -> DMat3 {
    volume_from_display.transpose() * (voxel_m / domain_width)
}

/// The scalar's gradients along a piece, at the piece's level and at those above that were asked for.
#[derive(Clone, Copy)]
pub struct Slopes([[Cubic; 3]; 3]);

impl Slopes {
    /// Of the piece's own gradients (data value, volume frame) at `levels`.
    pub fn new(matrix: &DMat3, levels: Levels, gradient: impl Fn(usize) -> [Cubic; 3]) -> Self {
        let mut slopes = [[Cubic::constant(0.0); 3]; 3];
        for (above, slope) in slopes.iter_mut().enumerate().take(levels.count()) {
            *slope = Cubic::transformed(matrix, &gradient(above));
        }
        Self(slopes)
    }

    /// The gradients at `u` of the piece, of the first `levels`.
    pub fn at(&self, levels: Levels, u: f64) -> [DVec3; 3] {
        let mut gradients = [DVec3::ZERO; 3];
        for (gradient, slope) in gradients.iter_mut().zip(&self.0).take(levels.count()) {
            *gradient = DVec3::from_array(slope.map(|g| g.at(u)));
        }
        gradients
    }

    /// Where the gradient turns from one side of `direction` to the other: u in (0, 1), in rising order.
    pub fn turns(&self, direction: DVec3) -> impl Iterator<Item = f64> + use<> {
        let along = |i: usize| DVec3::from_array(self.0[0].map(|g| g.0[i])).dot(direction);
        Cubic(std::array::from_fn(along)).sign_changes()
    }
}
