//! A straight path along which light is gathered.

use super::Ray;
use super::enhancer::Chain;
use super::shading::Shading;
use glam::DMat3;
use optics::Light;

/// A straight path, with all that depends on its direction.
pub struct Course {
    /// The way itself; pieces give their t along it.
    pub way: Ray,
    /// The light's answer for a viewer looking along it.
    pub shading: Option<Shading>,
    /// The t at which the chain's laws are not smooth, in rising order.
    pub breaks: Vec<f64>,
    /// From a field's gradients to those that shade: see [`super::slopes::shading_from_gradient`].
    pub shading_from_gradient: DMat3,
}

impl Course {
    /// Along `way`, through a scene with `light` and `chain`.
    pub fn new(way: Ray, light: Option<Light>, chain: &Chain, shading_from_gradient: DMat3) -> Self {
        let shading = light.map(|light| Shading::new(light, way.direction_in_display));
        Self { way, shading, breaks: chain.breaks(&way), shading_from_gradient }
    }
}
