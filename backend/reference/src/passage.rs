//! A piece on its way through the accumulator.

use super::band::Band;
use super::course::Course;
use super::enhanced::{Enhanced, Spread};
use super::enhancer::{Chain, Zones};
use super::field::Levels;
use super::medium::Medium;
use super::shading::Shader;
use super::slopes::Slopes;
use super::span::Span;
use super::{Cubic, Piece};

/// A piece, with its gradients where they are wanted.
pub struct Passage<'p> {
    /// The scalar, not clamped.
    pub scalar: Cubic,
    /// The half-width of the scalars that it stands for; None where it stands for itself.
    pub spread: Option<Cubic>,
    t0: f64,
    length_m: f64,
    course: &'p Course,
    slopes: Option<Slopes>,
}

impl<'p> Passage<'p> {
    /// `piece` of `course`, on which the scalar is `scalar` and its half-width `spread`, with its gradients of `levels`.
    pub fn new(
        piece: &Piece,
        (scalar, spread): (Cubic, Option<Cubic>),
        course: &'p Course,
        levels: Levels,
    ) -> Self {
        let matrix = &course.shading_from_gradient;
        let slopes = (levels > Levels::Zero).then(|| Slopes::new(matrix, levels, piece.gradient));
        Self { scalar, spread, t0: piece.t0, length_m: piece.t1 - piece.t0, course, slopes }
    }

    /// The light along the piece.
    pub fn shader(&self) -> Option<Shader<'_>> {
        let (shading, slopes) = (self.course.shading.as_ref()?, self.slopes.as_ref()?);
        Some(Shader { shading, slopes })
    }

    /// The u in (0, 1) at which a law of `chain` is not smooth.
    pub fn breaks(&self, chain: &Chain) -> impl Iterator<Item = f64> + '_ {
        let place = |t: &f64| (t - self.t0) / self.length_m;
        let edges = self.course.breaks.iter().map(place).filter(|&u| u > 0.0 && u < 1.0);
        let turns = chain.looks_along().zip(self.slopes).map(|(view, slopes)| slopes.turns(view));
        edges.chain(turns.into_iter().flatten())
    }

    /// The zones of `chain` between two u that no break separates.
    pub fn zones(&self, chain: &Chain, from: f64, to: f64) -> Zones {
        chain.zones(self.course.way.at(self.t(0.5 * (from + to))))
    }

    fn t(&self, u: f64) -> f64 {
        self.t0 + u * self.length_m
    }
}

/// A part of a piece that no break of the chain cuts.
#[derive(Clone, Copy)]
pub struct Stretch<'p> {
    /// The piece.
    pub passage: &'p Passage<'p>,
    /// Its light.
    pub shader: Option<&'p Shader<'p>>,
    /// The optics.
    pub medium: &'p Medium,
    /// The chain.
    pub chain: &'p Chain,
    /// Which parts of the chain's laws hold.
    pub zones: Zones,
}

/// A span, with what the chain makes of it.
pub struct Shown<'p> {
    /// The span as the scene has it.
    pub span: Span<'p>,
    stretch: Stretch<'p>,
    part: (f64, f64),
    has_law: bool,
}

impl<'p> Stretch<'p> {
    /// The part of the piece between two u, on which the scalar lies in `band`.
    pub fn part(&self, part: (f64, f64), band: &'p Band) -> Shown<'p> {
        let passage = self.passage;
        let span = Span::new(&passage.scalar, part, passage.length_m, band, self.shader);
        Shown { span, stretch: *self, part, has_law: self.chain.acts_in(&self.zones, band) }
    }
}

impl Shown<'_> {
    /// Whether it holds nothing.
    pub fn is_clear(&self) -> bool {
        self.stretch.passage.spread.is_none() && self.span.depth(1.0) <= 0.0
    }

    /// The span as the chain leaves it, of all that its values stand for; None if the chain leaves it alone and they stand for
    /// themselves.
    pub fn enhanced(&self) -> Option<Enhanced<'_>> {
        let Stretch { passage, chain, zones, medium, .. } = &self.stretch;
        (self.has_law || passage.spread.is_some()).then(|| Enhanced {
            span: &self.span,
            spread: passage.spread.map(|spread| Spread {
                medium,
                scalar: passage.scalar,
                half: spread,
                length_m: passage.length_m * (self.part.1 - self.part.0),
            }),
            chain,
            zones,
            way: &passage.course.way,
            t: (passage.t(self.part.0), passage.t(self.part.1)),
            part: self.part,
            slopes: passage.slopes.as_ref(),
        })
    }
}
