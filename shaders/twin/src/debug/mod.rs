//! What is shown instead of the picture, to look at the renderer itself.

mod heat;
mod node;
mod samples;

pub use heat::heat;

use super::composite::Light;
use super::features::Features;
use super::{Casting, Real, ray::Ray};
use optics::DebugView;

/// A segment's light around t: itself, where no debug view colours it.
#[inline(always)]
pub(super) fn debug_light<F: Real, K: Features>(
    casting: &Casting<F>,
    light: Light<F>,
    at: (&Ray<F>, F),
) -> Light<F> {
    if !K::IS_FULL {
        return light;
    }
    match casting.needs.debug {
        None | Some(DebugView::Samples) => light,
        Some(view) => node::light(casting, view, light, at),
    }
}

/// A ray's colour: itself, where no debug view counts its samples.
#[inline(always)]
pub(super) fn debug_pixel<F: Real>(casting: &Casting<F>, rgba: [F; 4], samples: u32) -> [F; 4] {
    if casting.needs.debug == Some(DebugView::Samples) { samples::pixel(samples) } else { rgba }
}
