//! What an eye sees: the screen as the sum of all projectors' pictures, seen from one point.

use super::{OutputError, Picture, PictureRef};
use display_config::CanonicalRaster;
use glam::DVec2;
use protocol::ProjectorImage;

/// Sums are integers in units of 2^-36: adding is then exact, so any order of arrival gives the same bytes.
const UNITS_PER_ONE: f64 = (1u64 << 36) as f64;
/// Colours are cut off here, so that a sum of a few cannot overflow 63 bits.
const BRIGHTEST: f64 = (1u64 << 24) as f64;
/// A sample this near to a pixel centre (pixels) is that pixel: coordinates carry rounding of about 1e-12.
const ALIGNED: f64 = 1e-9;
/// A sample this far outside a raster (pixels) still belongs to it: its edge carries the calibration's rounding.
const EDGE_TOLERANCE: f64 = 1e-3;

/// Which projector an eye sees at which pixel of the screen, and how strongly; fixed as long as the eye is.
#[derive(Clone, Debug)]
pub struct EyePlan {
    /// The pixels in which the eye's view of the whole screen is drawn.
    raster: CanonicalRaster,
    /// For each projector, the pixels it lights: (index in the raster, weight).
    lit: Vec<Vec<(u32, f64)>>,
}

impl EyePlan {
    /// `weights(screen point)` gives (projector, weight) pairs whose weights add to 1 if the eye sees light.
    pub fn new<W>(raster: CanonicalRaster, projectors: usize, weights: impl Fn(DVec2) -> W) -> Self
    where
        W: IntoIterator<Item = (usize, f64)>,
    {
        let mut lit = vec![Vec::new(); projectors];
        for index in 0..raster.width * raster.height {
            for (projector, weight) in weights(point_of_index(&raster, index)) {
                if weight > 0.0 {
                    lit[projector].push((index, weight));
                }
            }
        }
        Self { raster, lit }
    }

    /// How many projectors the eye sees at all.
    pub fn projectors_seen(&self) -> usize {
        self.lit.iter().filter(|pixels| !pixels.is_empty()).count()
    }
}

/// The view of one eye, in the making.
#[derive(Clone, Debug)]
pub struct EyeView<'a> {
    plan: &'a EyePlan,
    sums: Vec<[i64; 4]>,
}

impl<'a> EyeView<'a> {
    /// A dark view.
    pub fn new(plan: &'a EyePlan) -> Self {
        Self { plan, sums: vec![[0; 4]; (plan.raster.width * plan.raster.height) as usize] }
    }

    /// Adds what a projector shows. `pixel_from_screen` maps screen metres to that projector's pixel coordinates
    /// (centres at integer + 0.5); None, or a place outside the raster, adds nothing.
    pub fn add_image(
        &mut self,
        image: &ProjectorImage,
        pixel_from_screen: impl Fn(DVec2) -> Option<DVec2>,
    ) -> Result<(), OutputError> {
        let picture = PictureRef::of(image)?;
        let lit = self.plan.lit.get(image.projector as usize).map_or(&[][..], Vec::as_slice);
        for &(index, weight) in lit {
            let place = pixel_from_screen(point_of_index(&self.plan.raster, index));
            let Some(colour) = place.and_then(|p| bilinear(picture, p)) else { continue };
            let sums = &mut self.sums[index as usize];
            sums.iter_mut().zip(colour).for_each(|(sum, c)| *sum = sum.saturating_add(units(weight * c)));
        }
        Ok(())
    }

    /// The view so far: linear, premultiplied.
    pub fn picture(&self) -> Picture {
        let number = |sum: &i64| (*sum as f64 / UNITS_PER_ONE) as f32;
        let rgba = self.sums.iter().flat_map(|sums| sums.iter().map(number)).collect();
        Picture { width: self.plan.raster.width, height: self.plan.raster.height, rgba }
    }
}

fn point_of_index(raster: &CanonicalRaster, index: u32) -> DVec2 {
    raster.point(index % raster.width, index / raster.width)
}

/// A number in fixed-point units; NaN becomes 0 by the cast.
fn units(value: f64) -> i64 {
    (value.clamp(-BRIGHTEST, BRIGHTEST) * UNITS_PER_ONE).round() as i64
}

/// The picture between its pixel centres, constant in the outer half of border pixels; None outside the raster.
fn bilinear(picture: PictureRef<'_>, at: DVec2) -> Option<[f64; 4]> {
    let (x0, x1, fx) = neighbours(at.x, picture.width())?;
    let (y0, y1, fy) = neighbours(at.y, picture.height())?;
    let (top, bottom) = (blend(picture, (x0, x1, fx), y0), blend(picture, (x0, x1, fx), y1));
    Some(std::array::from_fn(|i| lerp(top[i], bottom[i], fy)))
}

/// The two pixels around a coordinate and the share of the second.
fn neighbours(coordinate: f64, count: u32) -> Option<(usize, usize, f64)> {
    let inside = coordinate > -EDGE_TOLERANCE && coordinate < f64::from(count) + EDGE_TOLERANCE;
    if !inside {
        return None;
    }
    let place = (coordinate - 0.5).clamp(0.0, f64::from(count - 1));
    let nearest = place.round();
    let place = if (place - nearest).abs() < ALIGNED { nearest } else { place };
    let first = place.floor() as usize;
    Some((first, (first + 1).min(count as usize - 1), place - place.floor()))
}

fn blend(picture: PictureRef<'_>, (x0, x1, share): (usize, usize, f64), y: usize) -> [f64; 4] {
    let (left, right) = (picture.pixel(x0, y), picture.pixel(x1, y));
    std::array::from_fn(|i| lerp(f64::from(left[i]), f64::from(right[i]), share))
}

/// Exact at share 0, even if `b` is infinite or NaN.
fn lerp(a: f64, b: f64, share: f64) -> f64 {
    if share == 0.0 { a } else { a + (b - a) * share }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RASTER: CanonicalRaster = CanonicalRaster { width: 8, height: 6, size_m: DVec2::new(1.6, 0.9) };

    fn image(projector: u32, colour: impl Fn(u32, u32) -> f32) -> ProjectorImage {
        let pixels = (0..6).flat_map(|y| (0..8).map(move |x| (x, y)));
        let rgba = pixels.flat_map(|(x, y)| [colour(x, y), 0.5, 0.25, 1.0]).collect();
        ProjectorImage { projector, width: 8, height: 6, rgba }
    }

    fn aligned(screen: DVec2) -> Option<DVec2> {
        let u = screen / RASTER.size_m;
        Some(DVec2::new((u.x + 0.5) * 8.0, (0.5 - u.y) * 6.0))
    }

    #[test]
    fn one_aligned_projector_is_seen_as_it_is() {
        let plan = EyePlan::new(RASTER, 1, |_| [(0, 1.0)]);
        let mut view = EyeView::new(&plan);
        let shown = image(0, |x, y| (x + 8 * y) as f32 / 48.0);
        view.add_image(&shown, aligned).unwrap();
        let worst =
            view.picture().rgba.iter().zip(&shown.rgba).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst <= 1e-10, "{worst}");
    }

    #[test]
    fn weights_mix_the_projectors() {
        let plan = EyePlan::new(RASTER, 2, |s| [(0, if s.x < 0.0 { 1.0 } else { 0.25 }), (1, 0.75)]);
        let mut view = EyeView::new(&plan);
        view.add_image(&image(0, |_, _| 1.0), aligned).unwrap();
        let picture = view.picture();
        assert_eq!(picture.rgba[0], 1.0);
        assert_eq!(picture.rgba[4 * 7], 0.25);
        assert_eq!(plan.projectors_seen(), 2);
    }

    #[test]
    fn half_a_pixel_away_is_the_mean_of_two() {
        let plan = EyePlan::new(RASTER, 1, |_| [(0, 1.0)]);
        let mut view = EyeView::new(&plan);
        let shift = |s| aligned(s).map(|p| p + DVec2::new(0.5, 0.0));
        view.add_image(&image(0, |x, _| x as f32), shift).unwrap();
        assert!((view.picture().rgba[4 * 2] - 2.5).abs() < 1e-6);
    }

    #[test]
    fn nothing_comes_from_outside_a_raster() {
        let plan = EyePlan::new(RASTER, 1, |_| [(0, 1.0)]);
        let mut view = EyeView::new(&plan);
        view.add_image(&image(0, |_, _| 1.0), |s| aligned(s).map(|p| p + DVec2::new(4.0, 0.0))).unwrap();
        let picture = view.picture();
        assert_eq!((picture.rgba[4 * 3], picture.rgba[4 * 4]), (1.0, 0.0));
    }

    proptest! {
        #[test]
        fn the_order_of_arrival_does_not_matter(seed in any::<u64>(), turn in 0usize..5) {
            let weight = |s: DVec2, p: usize| ((s.x * 37.0 + p as f64).sin() + 1.1) / 7.0;
            let plan = EyePlan::new(RASTER, 5, |s| (0..5).map(move |p| (p, weight(s, p))));
            let noise = |p: u32, x: u32, y: u32| {
                let h = (seed ^ u64::from(p * 1009 + x * 31 + y)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
                (h >> 40) as f32 / 1e5
            };
            let images: Vec<_> = (0..5).map(|p| image(p, |x, y| noise(p, x, y))).collect();
            let see = |order: &mut dyn Iterator<Item = usize>| {
                let mut view = EyeView::new(&plan);
                order.for_each(|p| view.add_image(&images[p], aligned).unwrap());
                view.picture().rgba.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
            };
            prop_assert_eq!(see(&mut (0..5)), see(&mut (0..5).rev().map(|p| (p + turn) % 5)));
        }
    }
}
