//! Pictures between their pixels: Catmull and Rom's cubic.

use planes::RasterWarp;
use rayon::prelude::*;

/// A picture of the raster that planes cast, on a projector's own: linear colours, four to a pixel.
///
/// # Panics
/// If the picture is not of that raster.
pub fn resampled(cast: &[f32], warp: &RasterWarp) -> Vec<f32> {
    let size = warp.common.map(|along| along as usize);
    assert_eq!(cast.len(), 4 * size[0] * size[1], "a picture of the raster that was cast");
    let [width, height] = warp.raster.map(|along| along as usize);
    let mut own = vec![0.0; 4 * width * height];
    own.par_chunks_mut(4 * width.max(1)).zip(0..warp.raster[1]).for_each(|(row, y)| {
        for (pixel, x) in row.chunks_exact_mut(4).zip(0..) {
            let place = warp.place(x, y).map(|at| (at - 0.5) as f32);
            let colour: [f32; 4] = between(cast, size, place);
            // The cubic rings beside edges; light is not negative, and opacity at most 1.
            let [rgb @ .., alpha] = colour.map(|channel| channel.max(0.0));
            pixel.copy_from_slice(&[rgb[0], rgb[1], rgb[2], alpha.min(1.0)]);
        }
    });
    own
}

/// Where a picture bends: pixels whose colours are far from the mean of both neighbours along x or y. The cubic may be far from what
/// a ray there would see.
pub struct Bends<'a> {
    warp: &'a RasterWarp,
    /// Of each pixel of the raster that was cast, whether one of the square around it and the next along x and y bends.
    bends: Vec<bool>,
}

/// Pixels of that square before the pixel, and after the next: what is thinner than a pixel may show beside a place alone.
const AROUND: usize = 1;

impl<'a> Bends<'a> {
    /// Of a picture of the raster that planes cast: those above `most`.
    pub fn of(cast: &[f32], warp: &'a RasterWarp, most: f32) -> Self {
        let [width, height] = warp.common.map(|along| along as usize);
        let pixel = |x: usize, y: usize| &cast[4 * (y * width + x)..][..4];
        let bends_at = |x: usize, y: usize| {
            let middle = pixel(x, y);
            let around = [[pixel(x - 1, y), pixel(x + 1, y)], [pixel(x, y - 1), pixel(x, y + 1)]];
            around.iter().any(|[a, b]| (0..4).any(|c| (a[c] + b[c] - 2.0 * middle[c]).abs() > most))
        };
        // First along each row, then along columns.
        let mut rows = vec![false; width * height];
        rows.par_chunks_mut(width).enumerate().skip(1).take(height.saturating_sub(2)).for_each(|(y, row)| {
            for x in (1..width - 1).filter(|&x| bends_at(x, y)) {
                row[x.saturating_sub(1 + AROUND)..(x + AROUND + 1).min(width)].fill(true);
            }
        });
        let mut bends = vec![false; width * height];
        bends.par_chunks_mut(width).enumerate().for_each(|(y, into)| {
            let square = y.saturating_sub(AROUND)..(y + AROUND + 2).min(height);
            for row in rows[square.start * width..square.end * width].chunks_exact(width) {
                into.iter_mut().zip(row).for_each(|(into, bends)| *into |= bends);
            }
        });
        Self { warp, bends }
    }

    /// Whether the picture bends where a pixel of the own raster takes its light from.
    pub fn are_near(&self, x: u32, y: u32) -> bool {
        let [column, row] = self.warp.place(x, y).map(|at| (at - 0.5).max(0.0) as usize);
        self.bends.get(row * self.warp.common[0] as usize + column).is_some_and(|&bends| bends)
    }
}

/// The first channels of a picture, which has four, at a place: pixels, the centre of the first one at 0.
///
/// The filter goes through the 4 × 4 pixels around the place. It errs less than bilinear interpolation the better the picture
/// resolves what it shows, and is no worse by much where it does not (tests/results/finish.md). Its negative lobes may ring
/// below black. What the picture lacks is black.
#[inline]
pub(super) fn between<const CHANNELS: usize>(
    rgba: &[f32],
    [width, height]: [usize; 2],
    [x, y]: [f32; 2],
) -> [f32; CHANNELS] {
    let (columns, across) = taps(x, width);
    let (rows, down) = taps(y, height);
    let mut sum = [0.0; CHANNELS];
    for (row, weight_down) in rows.into_iter().zip(down) {
        for (column, weight_across) in columns.into_iter().zip(across) {
            let pixel = 4 * (row * width + column);
            let Some(colour) = rgba.get(pixel..pixel + CHANNELS) else { continue };
            let weight = weight_down * weight_across;
            sum.iter_mut().zip(colour).for_each(|(sum, channel)| *sum += weight * channel);
        }
    }
    sum
}

/// The four pixels around a place along one axis, those beyond the rim replaced by the one at it, and their weights.
fn taps(place: f32, count: usize) -> ([usize; 4], [f32; 4]) {
    let first = place.floor();
    let t = place - first;
    let pixel = |offset: f32| ((first + offset).max(0.0) as usize).min(count.saturating_sub(1));
    let weights = [
        t * (t * (1.0 - 0.5 * t) - 0.5),
        t * t * (1.5 * t - 2.5) + 1.0,
        t * (t * (2.0 - 1.5 * t) + 0.5),
        t * t * (0.5 * t - 0.5),
    ];
    ([-1.0, 0.0, 1.0, 2.0].map(pixel), weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use planes::Fans;
    use twin::ProjectorRays;
    use twin::vector::Vec3;

    /// To a raster of 40 × 30 pixels that is turned a little.
    fn warp() -> RasterWarp {
        let view = |turn: f32| ProjectorRays {
            screen_from_pixel: [[0.01, turn, 0.0], [turn, -0.01, 0.0], [-0.2, 0.15, 1.0]].map(Vec3),
            beam: [0.1, 1.5, 0.0, 3.0],
            raster: [40, 30],
        };
        *Fans::of(&[view(3e-4), view(-1e-4)]).unwrap().warp(0).unwrap()
    }

    /// A picture of some function of the place, pixels, on the raster that is cast.
    fn picture(warp: &RasterWarp, colour: impl Fn(f64, f64) -> f64) -> Vec<f32> {
        let [width, height] = warp.common;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        places.flat_map(|(x, y)| [colour(f64::from(x) + 0.5, f64::from(y) + 0.5) as f32; 4]).collect()
    }

    #[test]
    fn what_is_straight_stays_so_and_does_not_bend() {
        let (warp, plane) = (warp(), |x: f64, y: f64| 0.01 * x + 0.003 * y);
        let cast = picture(&warp, plane);
        let (own, bends) = (resampled(&cast, &warp), Bends::of(&cast, &warp, 1e-5));
        for (x, y) in (0..30).flat_map(|y| (0..40).map(move |x| (x, y))) {
            let [u, v] = warp.place(x, y);
            let found = own[4 * (40 * y + x) as usize];
            assert!((f64::from(found) - plane(u, v)).abs() < 1e-6, "{x} {y}: {found}");
            assert!(!bends.are_near(x, y), "{x} {y}");
        }
    }

    #[test]
    fn edges_bend_and_ring_but_show_no_negative_light() {
        let warp = warp();
        let cast = picture(&warp, |x, _| if x < 20.0 { 0.0 } else { 1.0 });
        let (own, bends) = (resampled(&cast, &warp), Bends::of(&cast, &warp, 0.5));
        for (x, y) in (0..30).flat_map(|y| (0..40).map(move |x| (x, y))) {
            // The pixels on both sides of the edge bend, and all within two pixels and a half of it are near one that does.
            let aside = (warp.place(x, y)[0] - 20.0).abs();
            assert_eq!(bends.are_near(x, y), aside < 1.5 + AROUND as f64, "{x} {y}: {aside}");
            let pixel = &own[4 * (40 * y + x) as usize..][..4];
            assert!(pixel.iter().all(|&c| c >= 0.0) && pixel[3] <= 1.0, "{pixel:?}");
        }
        assert!(own.iter().any(|&c| c > 1.0), "nothing rings");
    }

    #[test]
    fn the_filter_keeps_pixels_and_straight_lines() {
        for place in [3.0, 3.2, 3.5, 3.9] {
            let (pixels, weights) = taps(place, 9);
            let sum: f32 = weights.iter().sum();
            let mean: f32 = pixels.iter().zip(weights).map(|(&pixel, weight)| pixel as f32 * weight).sum();
            assert!((sum - 1.0).abs() < 1e-6 && (mean - place).abs() < 1e-5, "{place}: {sum}, {mean}");
        }
        assert_eq!(taps(4.0, 9), ([3, 4, 5, 6], [0.0, 1.0, 0.0, 0.0]));
        assert_eq!(taps(-0.25, 2).0, [0, 0, 0, 1]);
        assert_eq!(taps(0.0, 1).0, [0; 4]);
    }
}
