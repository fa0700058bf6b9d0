//! How samples are accumulated along a ray.

mod mimda_consistent;
mod mimda_paper;
mod over;

pub use mimda_consistent::MimdaConsistent;
pub use mimda_paper::MimdaPaper;
pub use over::Over;

use super::{Real, Scene, vector::Vec3};

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
    pub fn then(self, beta: F, rgb: Vec3<F>, alpha: F, importance: F) -> Self {
        let through = F::ONE - beta * self.alpha;
        Self { rgb: self.rgb * beta + rgb * through, alpha: self.alpha * beta + alpha * through, importance }
    }
}

/// A module for the compositing slot.
pub trait Composite {
    /// Whether a segment without extinction changes nothing.
    fn is_clear<F: Real>(extinction: F) -> bool;
    /// A segment of opacity `alpha` and premultiplied `rgb`, over scalars [s0, s1], behind what is in front.
    fn composite<F: Real>(
        scene: &Scene<F>,
        front: Accumulated<F>,
        rgb: Vec3<F>,
        alpha: F,
        s0: F,
        s1: F,
    ) -> Accumulated<F>;
    /// The opacity that what follows may still add.
    fn still_to_come<F: Real>(scene: &Scene<F>, front: Accumulated<F>) -> F;
}
