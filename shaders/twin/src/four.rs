//! Four numbers at once: written out, so that the compiler sees one vector register.
//!
//! No closures here: a closure that is not inlined is compiled without the wider instructions of its caller.

use super::{Real, real::Number};

/// f of each component, written out.
macro_rules! each {
    ($c:ident => $value:expr) => {
        lanes::written_out!($c in [0 1 2 3] => $value)
    };
}
pub(super) use each;

/// a + (b − a) t.
#[inline(always)]
pub(super) fn mix<F: Number>(a: [F; 4], b: [F; 4], t: F) -> [F; 4] {
    each!(C => a[C] + (b[C] - a[C]) * t)
}

/// The value at (u, v) between four corners in the order 00, 10, 01, 11.
#[inline(always)]
pub(super) fn between_corners<F: Number>(corners: [F; 4], u: F, v: F) -> F {
    let (low, high) =
        (corners[0] + (corners[1] - corners[0]) * u, corners[2] + (corners[3] - corners[2]) * u);
    low + (high - low) * v
}

/// Stored f32 as this number type.
#[inline(always)]
pub(super) fn widen<F: Real>(stored: &[f32; 4]) -> [F; 4] {
    each!(C => F::of_f32(stored[C]))
}
