//! A picture against the truth, pixel by pixel.

use bricks::BrickSource;
use bricks::LodRule;
use display_config::{Display, Ray};
use protocol::{FrameState, ProjectorImage};
use rayon::prelude::*;
pub use reference::Errors;
use reference::{Integrator, Radiance, Reference};
use std::sync::Arc;

/// The cut that a frame asks for on a display.
pub fn lod_rule(display: &Display, frame: &FrameState) -> LodRule {
    LodRule::new(display, frame.display_from_volume, frame.quality.lod_scale)
}

/// A pixel and what it should be.
#[derive(Clone, Copy, Debug)]
pub struct TruePixel {
    /// Index of the projector.
    pub projector: u32,
    /// Pixel along x.
    pub x: u32,
    /// Pixel along y.
    pub y: u32,
    /// What a ray through its centre sees.
    pub truth: Radiance,
}

/// Every `stride`-th pixel of some projectors, by the reference. The tolerance is a hundredth of what is tested.
pub fn truth(
    display: &Display,
    frame: &FrameState,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    stride: u32,
) -> Vec<TruePixel> {
    let pixels = traced(display, frame, source, projectors, stride);
    for TruePixel { projector, x, y, truth } in &pixels {
        assert!(truth.reached, "the reference missed its own tolerance at {projector}: {x}, {y}");
    }
    pixels
}

/// The same, with pixels that tell that they missed the tolerance.
pub fn traced(
    display: &Display,
    frame: &FrameState,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    stride: u32,
) -> Vec<TruePixel> {
    let rule = lod_rule(display, frame);
    let reference = Reference::new(Arc::clone(source), frame, &rule, Integrator::default())
        .expect("a test scene has a reference");
    let truth = |ray: &Ray| {
        reference
            .radiance(ray.origin_in_display, ray.direction_in_display)
            .expect("every brick of a test scene can be read")
    };
    seen_by(display, frame, projectors, stride, truth)
}

/// Every `stride`-th pixel of some projectors along either axis: the projector, x and y.
pub fn places(display: &Display, projectors: &[u32], stride: u32) -> Vec<(u32, u32, u32)> {
    let mut places = Vec::new();
    for &projector in projectors {
        let raster = &display.projectors[projector as usize].raster;
        let along = |n: u32| (stride / 2..n).step_by(stride as usize);
        places.extend(along(raster.height).flat_map(|y| along(raster.width).map(move |x| (projector, x, y))));
    }
    places
}

/// What `sees` says of the rays of the same pixels.
pub fn seen_by(
    display: &Display,
    frame: &FrameState,
    projectors: &[u32],
    stride: u32,
    sees: impl Fn(&Ray) -> Radiance + Sync,
) -> Vec<TruePixel> {
    places(display, projectors, stride)
        .into_par_iter()
        .map(|(projector, x, y)| {
            let law = display
                .beam_law(projector as usize, frame.observer_in_display, frame.eta)
                .expect("a test scene goes with its display");
            let truth = sees(&law.ray(display.pixel_on_screen(projector as usize, x, y)));
            TruePixel { projector, x, y, truth }
        })
        .collect()
}

/// What errors must stay within, linear colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of the root of the mean square.
    pub rms: f64,
    /// Of what 99.9 % of the pixels stay within.
    pub p999: f64,
    /// Of the largest.
    pub max: f64,
}

impl Limits {
    /// Limits in units of 1/255.
    pub const fn of_255(rms: f64, p999: f64, max: f64) -> Self {
        Self { rms: rms / 255.0, p999: p999 / 255.0, max: max / 255.0 }
    }

    /// Whether errors stay within; a NaN does not.
    pub fn hold(&self, errors: &Errors) -> bool {
        errors.rms < self.rms && errors.p999 < self.p999 && errors.max < self.max
    }
}

/// Pictures against the truth.
pub fn errors(images: &[ProjectorImage], truth: &[TruePixel]) -> Errors {
    let pairs = truth.iter().map(|pixel| {
        let image = images
            .iter()
            .find(|image| image.projector == pixel.projector)
            .expect("every projector with truth has a picture");
        let at = 4 * (pixel.y as usize * image.width as usize + pixel.x as usize);
        let found: [f32; 4] = image.rgba[at..at + 4].try_into().expect("four numbers per pixel");
        let [r, g, b] = pixel.truth.rgb.to_array();
        (found.map(f64::from), [r, g, b, pixel.truth.opacity])
    });
    errors_of(pairs)
}

/// Pictures against other pictures of the same projectors, every pixel.
pub fn errors_between(found: &[ProjectorImage], expected: &[ProjectorImage]) -> Errors {
    assert_eq!(found.len(), expected.len(), "both made the same pictures");
    let numbers = |pixel: &[f32]| -> [f64; 4] { std::array::from_fn(|c| f64::from(pixel[c])) };
    errors_of(found.iter().zip(expected).flat_map(|(found, expected)| {
        assert_eq!((found.projector, found.rgba.len()), (expected.projector, expected.rgba.len()));
        let pixels = found.rgba.chunks_exact(4).zip(expected.rgba.chunks_exact(4));
        pixels.map(move |(a, b)| (numbers(a), numbers(b)))
    }))
}

/// The two lines above rows that begin with such columns and end in [`cells`].
pub fn heads(columns: [&str; 2]) -> String {
    let [first, second] = columns;
    format!(
        "| {first} | {second} | pixels | lit | RMS | 99.9 % | largest |\n| --- | --- | ---: | ---: | ---: | ---: | ---: |"
    )
}

/// Cells of a table, of 1/255: pixels, those lit, RMS, what 99.9 % stay within, the largest.
pub fn cells(errors: &Errors) -> String {
    let [rms, p999, max] = [errors.rms, errors.p999, errors.max].map(|error| 255.0 * error);
    format!("{} | {} | {rms:.3} | {p999:.2} | {max:.1}", errors.pixels, errors.lit)
}

/// RMS, what 99.9 % stay within and the largest, of 255, in one cell.
pub fn codes(errors: &Errors) -> String {
    let [rms, p999, max] = [errors.rms, errors.p999, errors.max].map(|error| 255.0 * error);
    format!("{rms:.3}, {p999:.2}, {max:.2}")
}

/// Errors of pairs (found, true).
pub fn errors_of(pairs: impl Iterator<Item = ([f64; 4], [f64; 4])>) -> Errors {
    Errors::of(pairs).expect("something was compared")
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: Limits = Limits { rms: 1e9, p999: 1e9, max: 1e9 };

    #[test]
    fn a_nan_in_any_number_holds_within_no_limits() {
        for c in 0..4 {
            let mut found = [0.5; 4];
            found[c] = f64::NAN;
            let errors = errors_of([(found, [0.5; 4]), ([0.5; 4], [0.5; 4])].into_iter());
            assert!(errors.max.is_nan() && !WIDE.hold(&errors), "{errors}");
        }
    }
}
