//! What must be known of an enhancer wherever it is not applied: what it needs, and how far it may go.

use super::checks::Checked;
use crate::Trapezoid;
use glam::DVec3;

/// An enhancer's law, as all but its kernel and its twin know it.
pub trait Law {
    /// Its keys in a scene file, besides `kind` and `carried`.
    const KEYS: &'static [&'static str];
    /// Whether it looks at gradients.
    const NEEDS_GRADIENT: bool = false;
    /// Whether it looks at bands of scalars.
    const NEEDS_BAND: bool = false;

    /// Whether it looks at importance where none is accumulated, too.
    const NEEDS_IMPORTANCE: bool = false;

    /// Checks what the types do not.
    ///
    /// # Errors
    /// A number is out of its bounds.
    fn check(&self) -> Checked;

    /// Whether it leaves every picture as it is.
    fn is_neutral(&self) -> bool;

    /// The largest factor that it may multiply an extinction by in a box with these corners in the display frame, at least 1.
    fn most_factor(&self, _corners: &[DVec3; 8]) -> f64 {
        1.0
    }

    /// Whether it may change anything of a volume with these corners in the display frame. A tool that is held away from
    /// the volume does not; the box around the corners stands for the volume.
    fn may_act_within(&self, _corners: &[DVec3; 8]) -> bool {
        true
    }

    /// The largest importance that it may leave to scalars in [lo, hi] of which none had more than `before`.
    fn most_importance(&self, _lo: f64, _hi: f64, before: f64) -> f64 {
        before
    }

    /// Its band of scalars, where it has one.
    fn band_mut(&mut self) -> Option<&mut Trapezoid> {
        None
    }

    /// Puts it to a point (metres, display frame), and along the axis of a tool where one carries it.
    fn place(&mut self, point_in_display: DVec3, axis_in_display: Option<DVec3>);
}
