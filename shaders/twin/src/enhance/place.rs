//! Where enhancers look.

use crate::ray::Line;
use crate::real::Number;
use crate::vector::Vec3;

/// A segment that enhancers change, of one ray or of eight side by side.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a, N> {
    /// The straight way that it lies on.
    pub line: &'a Line<N>,
    /// Its middle.
    pub t: N,
    /// Metres.
    pub length: N,
    /// The scalars at its ends.
    pub scalars: (N, N),
    /// In its middle, per finest voxel, display frame; only where enhancers look at it.
    pub gradient: Vec3<N>,
}

/// What enhancers know of where a segment lies.
#[derive(Clone, Copy, Debug)]
pub struct Place<N> {
    /// Middle of the segment, metres, display frame.
    pub point: Vec3<N>,
    /// From there to the end of the segment.
    pub reach: Vec3<N>,
    /// Of the scalar there, per finest voxel, display frame.
    pub gradient: Vec3<N>,
    /// The scalars at the segment's ends.
    pub scalars: (N, N),
    /// The direction in which the ray left the eye.
    pub view: Vec3<N>,
    /// Whether the scene accumulates importance.
    pub has_importance: bool,
}

impl<N: Number> Segment<'_, N> {
    /// Its place, seen along `view`.
    #[inline(always)]
    pub(super) fn place(&self, view: Vec3<N>, has_importance: bool) -> Place<N> {
        Place {
            point: self.line.point(self.t),
            reach: self.line.direction * (self.t.alike(0.5) * self.length),
            gradient: self.gradient,
            scalars: self.scalars,
            view,
            has_importance,
        }
    }
}
