//! The field of a closed formula.

use super::fit::{Fit, GRADIENT_SLACK, MOST_BISECTIONS};
use super::{Field, Line, Piece, Visitor};
use bricks::BrickError;
use glam::DVec3;
use std::ops::ControlFlow;

/// Stretches of a line that are looked at separately where no scale is given.
const DEFAULT_STRETCHES: f64 = 32.0;

/// A field given by its value and its gradient, over the box [0, extent] of the volume frame. Along a line it is
/// fitted by cubics.
pub struct AnalyticField<V, G> {
    extent: DVec3,
    value: V,
    gradient: G,
    smooth_over_voxels: Option<f64>,
}

impl<V, G> AnalyticField<V, G>
where
    V: Fn(DVec3) -> f64 + Send + Sync,
    G: Fn(DVec3) -> DVec3 + Send + Sync,
{
    /// `value` is the data value at a point, `gradient` its gradient per finest voxel: the exact one, or central
    /// differences where the picture of stored samples is to be matched.
    pub fn new(extent: DVec3, value: V, gradient: G) -> Self {
        Self { extent, value, gradient, smooth_over_voxels: None }
    }

    /// Says that no feature is shorter than `voxels`, so that none can hide between the points of the first fit;
    /// without it, 1/32 of the line is taken.
    pub fn smooth_over(self, voxels: f64) -> Self {
        Self { smooth_over_voxels: Some(voxels), ..self }
    }

    fn stretches(&self, line: &Line, within: (f64, f64)) -> usize {
        let voxels = (within.1 - within.0) * line.direction.length();
        self.smooth_over_voxels.map_or(DEFAULT_STRETCHES, |scale| (voxels / scale).ceil().max(1.0)) as usize
    }

    fn fit_value(&self, line: &Line, (t0, t1): (f64, f64)) -> Fit<1> {
        Fit::new(|u| [(self.value)(line.at(t0 + u * (t1 - t0)))])
    }

    fn fit_gradient(&self, line: &Line, (t0, t1): (f64, f64)) -> Fit<3> {
        Fit::new(|u| (self.gradient)(line.at(t0 + u * (t1 - t0))).to_array())
    }

    fn visit(
        &self,
        line: &Line,
        part: (f64, f64),
        accuracy: f64,
        left: u32,
        visitor: &mut dyn Visitor,
    ) -> ControlFlow<()> {
        let value = self.fit_value(line, part);
        let gradient = self.fit_gradient(line, part);
        let is_good = value.error <= accuracy && gradient.error <= accuracy * GRADIENT_SLACK;
        let middle = 0.5 * (part.0 + part.1);
        if is_good || left == 0 || middle <= part.0 || middle >= part.1 {
            let piece = Piece {
                t0: part.0,
                t1: part.1,
                value: value.cubics[0],
                deviation: None,
                gradient: &|_| gradient.cubics,
            };
            return visitor.piece(&piece);
        }
        self.visit(line, (part.0, middle), accuracy, left - 1, visitor)?;
        self.visit(line, (middle, part.1), accuracy, left - 1, visitor)
    }
}

impl<V, G> Field for AnalyticField<V, G>
where
    V: Fn(DVec3) -> f64 + Send + Sync,
    G: Fn(DVec3) -> DVec3 + Send + Sync,
{
    fn extent(&self) -> DVec3 {
        self.extent
    }

    fn value(&self, point: DVec3) -> Result<f64, BrickError> {
        Ok((self.value)(point))
    }

    fn gradient(&self, point: DVec3) -> Result<DVec3, BrickError> {
        Ok((self.gradient)(point))
    }

    fn sample(&self, point: DVec3, _wants: &dyn Fn(f64, f64) -> bool) -> Result<(f64, DVec3), BrickError> {
        let point = point.clamp(DVec3::ZERO, self.extent);
        Ok(((self.value)(point), (self.gradient)(point)))
    }

    fn walk(
        &self,
        line: &Line,
        within: (f64, f64),
        accuracy: f64,
        visitor: &mut dyn Visitor,
    ) -> Result<(), BrickError> {
        let stretches = self.stretches(line, within);
        let at = |i: usize| within.0 + (within.1 - within.0) * (i as f64 / stretches as f64);
        for i in 0..stretches {
            let end = if i + 1 == stretches { within.1 } else { at(i + 1) };
            let part = (at(i), end);
            if part.0 < part.1 && self.visit(line, part, accuracy, MOST_BISECTIONS, visitor).is_break() {
                break;
            }
        }
        Ok(())
    }
}
