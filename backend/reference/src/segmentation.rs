//! LFD eq. 3 as published, over segments that the caller gives.

use super::accumulator::Accumulator;
use super::field::Levels;
use super::medium::Medium;
use super::rise::State;
use super::{Piece, Radiance, Visitor};
use glam::DVec3;
use std::ops::ControlFlow;

/// Boundaries of segments along a ray: t in metres, rising.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    boundaries_m: Vec<f64>,
}

/// Why boundaries do not make segments.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SegmentationError {
    /// A boundary is not a number, or lies before the one ahead of it.
    #[error(
        "segment boundary {index} is infinite or NaN, or lies before the previous one; sort the boundaries"
    )]
    NotRising {
        /// Which boundary, from 0.
        index: usize,
    },
}

impl Segmentation {
    /// Checks that the boundaries are finite and do not fall.
    pub fn new(boundaries_m: Vec<f64>) -> Result<Self, SegmentationError> {
        let falls = |i: usize| i > 0 && boundaries_m[i - 1] > boundaries_m[i];
        match (0..boundaries_m.len()).find(|&i| !boundaries_m[i].is_finite() || falls(i)) {
            Some(index) => Err(SegmentationError::NotRising { index }),
            None => Ok(Self { boundaries_m }),
        }
    }

    /// `count` equal segments from `start_m` to `end_m`.
    pub fn uniform(start_m: f64, end_m: f64, count: u32) -> Result<Self, SegmentationError> {
        let at = |i: u32| start_m + (end_m - start_m) * (f64::from(i) / f64::from(count));
        Self::new((0..=count).map(at).collect())
    }

    /// Start and end of each segment.
    pub fn segments(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.boundaries_m.windows(2).map(|pair| (pair[0], pair[1]))
    }
}

/// A segment composited alone, that remembers the scalar at its ends.
pub struct Segment<'a> {
    light: Accumulator<'a>,
    ends: Option<(f64, f64)>,
    is_opaque: bool,
}

impl<'a> Segment<'a> {
    /// At the segment's start.
    pub fn new(light: Accumulator<'a>) -> Self {
        Self { light: light.without_importance(), ends: None, is_opaque: false }
    }

    /// Its light, and the data values at its start and end; None if it met nothing.
    pub fn seen(&self) -> Option<(Radiance, (f64, f64))> {
        self.ends.map(|ends| (self.light.radiance(), ends))
    }
}

impl Visitor for Segment<'_> {
    fn wants(&self, _low: f64, _high: f64) -> bool {
        true
    }

    fn levels(&self) -> Levels {
        self.light.levels()
    }

    fn piece(&mut self, piece: &Piece) -> ControlFlow<()> {
        let start = self.ends.map_or(piece.value.0[0], |ends| ends.0);
        self.ends = Some((start, piece.value.0[3]));
        // The far end's value is wanted even where nothing more is visible.
        self.is_opaque = self.is_opaque || self.light.piece(piece).is_break();
        ControlFlow::Continue(())
    }
}

/// The ray so far, in LFD eq. 3.
pub struct Published<'a> {
    medium: &'a Medium,
    state: State,
    importance: f64,
    reached: bool,
}

impl<'a> Published<'a> {
    /// At the start of a ray.
    pub fn new(medium: &'a Medium) -> Self {
        let state = State { rgb: DVec3::ZERO, opacity: 0.0, error: 0.0 };
        Self { medium, state, importance: 0.0, reached: true }
    }

    /// [c* α*] ← β [c* α*] + (1 − β α*) [c α], with the importance of the segment the mean of ι over the scalars between
    /// its ends.
    pub fn add(&mut self, segment: Radiance, ends: (f64, f64)) {
        let mut beta = 1.0;
        if let Some(erasure) = self.medium.erasure {
            let optics = self.medium.optics();
            let importance = self.medium.mean_importance(optics.normalise(ends.0), optics.normalise(ends.1));
            if importance > self.importance {
                beta = erasure.kept_by_one_step(self.importance, importance);
                self.importance = importance;
            }
        }
        let through = 1.0 - beta * self.state.opacity;
        self.state.rgb = beta * self.state.rgb + through * segment.rgb;
        self.state.opacity = beta * self.state.opacity + through * segment.opacity;
        self.state.error = beta * self.state.error + through * segment.error_estimate;
        self.reached &= segment.reached;
    }

    /// What was seen so far.
    pub fn radiance(&self) -> Radiance {
        let State { rgb, opacity, error } = self.state;
        Radiance { rgb, opacity, error_estimate: error, reached: self.reached }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boundaries_must_not_fall() {
        assert_eq!(Segmentation::new(vec![0.0, 2.0, 1.0]), Err(SegmentationError::NotRising { index: 2 }));
        assert_eq!(Segmentation::new(vec![f64::NAN]), Err(SegmentationError::NotRising { index: 0 }));
        assert_eq!(Segmentation::uniform(1.0, 2.0, 4).unwrap().segments().count(), 4);
    }
}
