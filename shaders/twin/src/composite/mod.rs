//! How samples are accumulated along a ray.

mod mimda;
mod mimda_consistent;
mod mimda_paper;
mod over;
mod sample;

pub use mimda::{Form, Mimda};
pub use mimda_consistent::Consistent;
pub use mimda_paper::Paper;
pub use over::Over;
pub use sample::Sample;

use super::tables::TablePlace;
use super::{Casting, Real, real::Number, vector::Vec3};

/// What has been gathered so far.
#[derive(Clone, Copy, Debug)]
pub struct Accumulated<F> {
    /// Linear RGB, premultiplied.
    pub rgb: Vec3<F>,
    /// Opacity.
    pub alpha: F,
    /// ι_max; stays 0 in ordinary compositing.
    pub importance: F,
}

impl<F: Real> Accumulated<F> {
    /// Before the first sample.
    pub const NOTHING: Self = Self { rgb: Vec3::ZERO, alpha: F::ZERO, importance: F::ZERO };

    /// `self` kept to β, with a segment behind it.
    #[inline(always)]
    pub fn then(self, beta: F, light: Light<F>, importance: F) -> Self {
        let through = F::ONE - beta * self.alpha;
        Self {
            rgb: self.rgb * beta + light.rgb * through,
            alpha: self.alpha * beta + light.alpha * through,
            importance,
        }
    }
}

impl<F: Number> Accumulated<F> {
    /// `self` with a segment behind it, whatever its importance.
    #[inline(always)]
    pub fn over(self, light: Light<F>) -> Self {
        let Light { rgb, alpha } = Light { rgb: self.rgb, alpha: self.alpha }.then(light);
        Self { rgb, alpha, importance: self.importance }
    }
}

/// The light of a segment, composited alone.
#[derive(Clone, Copy, Debug)]
pub struct Light<F> {
    /// Linear RGB, premultiplied.
    pub rgb: Vec3<F>,
    /// Opacity.
    pub alpha: F,
}

impl<F: Real> Light<F> {
    /// Of nothing.
    pub const NONE: Self = Self { rgb: Vec3::ZERO, alpha: F::ZERO };
}

impl<F: Number> Light<F> {
    /// `self` with another segment behind it.
    #[inline(always)]
    pub fn then(self, behind: Self) -> Self {
        let through = self.alpha.alike(1.0) - self.alpha;
        Self { rgb: self.rgb + behind.rgb * through, alpha: self.alpha + behind.alpha * through }
    }
}

/// A module for the compositing slot.
pub trait Composite {
    /// Whether segments lie one behind the other, whatever they mean.
    const IS_OVER: bool;
    /// Whether it looks at importance.
    const READS_IMPORTANCE: bool;
    /// Whether the parts of a step are composited among themselves first.
    const ONCE_PER_STEP: bool;
    /// What a segment between the places of two scalars shows, whose mean (τ c, τ) is `k`.
    fn sample_of<F: Real>(casting: &Casting<F>, k: [F; 4], places: [&TablePlace<F>; 2]) -> Sample<F>;
    /// Whether a segment without extinction changes nothing.
    fn is_clear<F: Real>(extinction: F) -> bool;
    /// A segment's light, behind what is in front.
    fn composite<F: Real>(
        casting: &Casting<F>,
        front: Accumulated<F>,
        light: Light<F>,
        sample: &Sample<F>,
    ) -> Accumulated<F>;
    /// Parts of each step of a pair, by what a rise of importance over the scalars within reach may have erased unseen.
    fn parts_of_rise<F: Real>(casting: &Casting<F>, front: Accumulated<F>, reach: &Sample<F>) -> F;
    /// The opacity that what follows may still add.
    fn still_to_come<F: Real>(casting: &Casting<F>, front: Accumulated<F>) -> F;
}
