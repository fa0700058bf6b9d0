//! Pixels of marks that the volume may hide.

use display_config::Ray;
use protocol::Paint;

/// What a mark adds to one pixel, at a depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fragment {
    /// The pixel's place in the picture, row by row.
    pub pixel: u32,
    /// The pixel's ray.
    pub ray: Ray,
    /// How far from the ray's start the mark lies, metres.
    pub distance_m: f64,
    /// Its colour; the opacity is that of what it covers of the pixel.
    pub paint: Paint,
}

impl Fragment {
    /// Lays it into a pixel of which `before` is the part of the ray that ends there: linear colours, premultiplied by their
    /// opacity. With an opaque mark the pixel is that part over the mark; with one of opacity a, the mean of this and of what it
    /// was, with weight a. That is what the ray sees if the mark is one more thing on its way.
    pub fn lay_behind(&self, before: [f32; 4], pixel: &mut [f32]) {
        let Paint { rgb: [r, g, b], opacity } = self.paint;
        let seen = 1.0 - before[3];
        let backed = [r, g, b, 1.0].into_iter().zip(before).map(|(own, before)| before + seen * own);
        pixel.iter_mut().zip(backed).for_each(|(part, backed)| *part += opacity * (backed - *part));
    }
}

/// Sorts fragments pixel by pixel, the farthest first, so that each can be laid over what lies behind it. Those as far stay in
/// their order.
pub(crate) fn sort(fragments: &mut [Fragment]) {
    fragments.sort_by(|a, b| a.pixel.cmp(&b.pixel).then(b.distance_m.total_cmp(&a.distance_m)));
}
