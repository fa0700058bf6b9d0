//! What bends light at a point: the index and its gradient.

use super::Index;
use super::runge_kutta::Pose;
use crate::Field;
use bricks::BrickError;
use glam::{DAffine3, DVec3};
use optics::Optics;

/// A field seen as a refraction index.
///
/// The direction v of light changes along its way as dv/dt = (∇ν − (∇ν·v) v) / ν, which is the ray equation
/// d(ν v)/dt = ∇ν for a v of unit length. ∇ν = dν/ds · ∇s, with ∇s from the gradient that shades, per metre of the
/// display frame. Nodes that show nothing bend nothing.
pub struct Bending<'a> {
    /// The scalar.
    pub field: &'a dyn Field,
    /// ν.
    pub index: &'a Index,
    /// Domain, and which nodes show nothing.
    pub optics: &'a Optics,
    /// The volume's placement.
    pub volume_from_display: DAffine3,
}

/// The scalar and its gradient at a point.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// Scalar, not clamped: beyond [0, 1] the index does not change.
    pub scalar: f64,
    /// Per metre, display frame.
    pub gradient: DVec3,
}

impl Bending<'_> {
    /// The scalar at a point of the display frame.
    pub fn local(&self, point: DVec3) -> Result<Local, BrickError> {
        let (low, high) = self.optics.domain;
        let shown = |min: f64, max: f64| !self.optics.is_empty_on(min, max);
        let (value, gradient) =
            self.field.sample(self.volume_from_display.transform_point3(point), &shown)?;
        let per_metre = self.volume_from_display.matrix3.transpose();
        let scalar = (value - low) / (high - low);
        let scalar = if scalar.is_nan() { 0.0 } else { scalar };
        Ok(Local { scalar, gradient: per_metre * gradient / (high - low) })
    }

    /// The phase of the index at a point.
    pub fn phase(&self, point: DVec3) -> Result<usize, BrickError> {
        Ok(self.index.phase(self.local(point)?.scalar))
    }

    /// dv/dt in a phase of the index, 1/metre.
    pub fn turning(&self, phase: usize, pose: Pose) -> Result<DVec3, BrickError> {
        let local = self.local(pose.point)?;
        let (index, slope) = self.index.at(phase, local.scalar);
        if slope == 0.0 || !local.gradient.is_finite() {
            return Ok(DVec3::ZERO);
        }
        let gradient = slope * local.gradient;
        Ok((gradient - gradient.dot(pose.direction) * pose.direction) / index)
    }
}
