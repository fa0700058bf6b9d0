//! The warp by a mesh: what each pixel of a projector sees of the picture that was drawn.

use display_config::{Mesh, Raster};
use glam::DVec2;
use layout::present::NOWHERE;
use rayon::prelude::*;

/// A place this far outside the picture (pixels) still belongs to it: a mesh has its points in f32.
const EDGE_PX: f64 = 1e-3;

/// Where in the picture each pixel takes its light from.
pub(super) struct Warp {
    /// Pixel coordinates less a half: the centre of the picture's first pixel is at 0.
    pub(super) places: Vec<[f32; 2]>,
}

impl Warp {
    pub fn new(mesh: &Mesh, raster: &Raster) -> Self {
        let (size, inverse) = (raster.size(), raster.inverse());
        let place = |x: u32, y: u32| {
            let share = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / size;
            let place = inverse.and_then(|inverse| inverse.pixel(mesh.screen(share)))?;
            let is_inside = place.cmpge(DVec2::splat(-EDGE_PX)).all() && place.cmple(size + EDGE_PX).all();
            is_inside.then(|| (place - 0.5).as_vec2().to_array())
        };
        let mut places = vec![[NOWHERE; 2]; raster.width as usize * raster.height as usize];
        places.par_chunks_mut(raster.width.max(1) as usize).zip(0..raster.height).for_each(|(row, y)| {
            row.iter_mut().zip(0..).for_each(|(into, x)| *into = place(x, y).unwrap_or([NOWHERE; 2]));
        });
        Self { places }
    }

    /// The light that falls to a pixel, by its number; black where it sees none of the picture.
    ///
    /// The filter is Catmull and Rom's cubic through the 4 × 4 pixels around the place. It errs less than bilinear
    /// interpolation the better the picture resolves what it shows, and is no worse by much where it does not
    /// (tests/results/finish.md). Its negative lobes may ring below black.
    pub fn colour(&self, rgba: &[f32], [width, height]: [usize; 2], at: usize) -> [f32; 3] {
        let [x, y] = self.places[at];
        if x == NOWHERE {
            return [0.0; 3];
        }
        let (columns, across) = taps(x, width);
        let (rows, down) = taps(y, height);
        let mut sum = [0.0; 3];
        for (row, weight_down) in rows.into_iter().zip(down) {
            for (column, weight_across) in columns.into_iter().zip(across) {
                let pixel = 4 * (row * width + column);
                let Some(colour) = rgba.get(pixel..pixel + 3) else { continue };
                let weight = weight_down * weight_across;
                sum.iter_mut().zip(colour).for_each(|(sum, channel)| *sum += weight * channel);
            }
        }
        sum
    }
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
