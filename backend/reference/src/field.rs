//! What a field of data values must answer to be integrated.

use super::{Cubic, Line};
use bricks::BrickError;
use glam::DVec3;
use std::ops::ControlFlow;

/// Of how many levels a visitor wants gradients: the sample's own, and so many above it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Levels {
    /// None at all.
    Zero,
    /// The sample's own.
    One,
    /// That and the one above.
    Two,
    /// That and the two above.
    Three,
}

impl Levels {
    /// How many these are.
    pub fn count(self) -> usize {
        self as usize
    }
}

/// A part of a line on which the field is smooth: one cubic of u in [0, 1], with t = t0 + u (t1 − t0).
pub struct Piece<'a> {
    /// Where it starts, metres.
    pub t0: f64,
    /// Where it ends, metres; above t0.
    pub t1: f64,
    /// The data value.
    pub value: Cubic,
    /// The standard deviation of the data that the value stands for; None where it stands for itself.
    pub deviation: Option<Cubic>,
    /// The gradient of the data value, in the volume frame, per finest voxel, so many levels above the sample's own;
    /// asked for only where it is needed, and only for levels that the visitor wants.
    pub gradient: &'a dyn Fn(usize) -> [Cubic; 3],
}

/// Who is shown the pieces of a line.
pub trait Visitor {
    /// Whether it wants to see a stretch whose data values all lie in [low, high].
    fn wants(&self, low: f64, high: f64) -> bool;
    /// Of how many levels it wants gradients.
    fn levels(&self) -> Levels;
    /// Takes the next piece; breaks when it has seen enough.
    fn piece(&mut self, piece: &Piece) -> ControlFlow<()>;
}

/// A scalar field over the box [0, extent] of the volume frame.
pub trait Field: Send + Sync {
    /// The far corner of the box, finest voxels.
    fn extent(&self) -> DVec3;
    /// The data value at a point of the box.
    fn value(&self, point: DVec3) -> Result<f64, BrickError>;
    /// The gradient of the data value at a point of the box, volume frame, per finest voxel.
    fn gradient(&self, point: DVec3) -> Result<DVec3, BrickError>;
    /// The data value and its gradient at a point, which is moved into the box where it lies outside. In a node of whose
    /// values, all in [low, high], `wants` says no: its lowest value, and no gradient.
    fn sample(&self, point: DVec3, wants: &dyn Fn(f64, f64) -> bool) -> Result<(f64, DVec3), BrickError>;
    /// Shows `visitor` the pieces of `line` between the two t of `within`, in rising t, split at every t where the
    /// field is not smooth. `within` must lie in the box. A field that is not made of cubics fits them to `accuracy`
    /// (data value).
    fn walk(
        &self,
        line: &Line,
        within: (f64, f64),
        accuracy: f64,
        visitor: &mut dyn Visitor,
    ) -> Result<(), BrickError>;
}
