//! A band picker, seen along one ray.

use crate::medium::Linear;
use glam::DVec3;
use optics::{BandPicker, CurveValue};

/// The law of [`BandPicker`] for one direction of view.
#[derive(Clone, Copy, Debug)]
pub struct Picker {
    /// w: strength times how much the ray looks along the tool.
    pub weight: f64,
}

impl Picker {
    /// For a ray that left the eye along `view`.
    pub fn new(picker: &BandPicker, view: DVec3) -> Self {
        let along = picker.axis_in_display.dot(view).max(0.0);
        Self { weight: picker.strength * picker.facing.at(along) }
    }

    /// Factor of the extinction where the band has the value `share`.
    pub fn factor(&self, share: f64) -> f64 {
        1.0 - self.weight * (1.0 - share)
    }

    /// Importance where it was `importance` and the band has the value `share`.
    pub fn importance(&self, importance: f64, share: f64) -> f64 {
        importance.lerp(share, self.weight)
    }

    /// The same over a band of the medium, on which both are linear.
    pub fn importance_on(&self, told: Linear<f64>, share: Linear<f64>) -> Linear<f64> {
        Linear(told.0.lerp(share.0, self.weight), told.1.lerp(share.1, self.weight))
    }
}
