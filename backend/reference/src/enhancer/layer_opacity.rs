//! A layer's opacity, seen along one ray.

use glam::DVec3;
use optics::{CurveValue, LayerOpacity};

/// The law of [`LayerOpacity`] for one direction of view.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// μ: factor of the layer's extinction.
    pub factor: f64,
}

impl Layer {
    /// For a ray that left the eye along `view`.
    pub fn new(layer: &LayerOpacity, view: DVec3) -> Self {
        let facing = layer.facing.at(layer.axis_in_display.dot(view));
        Self { factor: layer.away.lerp(layer.toward, facing) }
    }

    /// Factor of the extinction where the band has the value `share`.
    pub fn factor(&self, share: f64) -> f64 {
        1.0 + share * (self.factor - 1.0)
    }
}
