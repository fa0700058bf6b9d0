//! A level's picture, reconstructed from its rays by a Gaussian.
//!
//! The weight of a sample at a distance d is exp(−α d²) − exp(−α r²) up to r, and 0 beyond (STE eq. 4); a colour is the
//! weighted mean. STE gives no α and r: here r is the least radius within which every pixel has some number of samples,
//! periodic copies included, and α r² is a number for itself. At the rim of the picture, where copies cannot be seen, a
//! pixel without any takes the nearest.

use super::Samples;
use super::samples::CHANNELS;
use rayon::prelude::*;

/// How wide the Gaussian is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// Samples that every pixel has at least.
    pub least: usize,
    /// α r²: how far the Gaussian falls before it is cut.
    pub falloff: f64,
}

/// A level: rays, and which of them make each pixel.
#[derive(Clone, Debug)]
pub struct Level {
    samples: Samples,
    radius: f64,
    /// Of each pixel, where its rays begin in `rays`; one more at the end.
    starts: Vec<u32>,
    /// Rays with their weights: the paper's S(x, y).
    rays: Vec<(u32, f32)>,
}

/// What was reconstructed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reconstructed {
    /// Colours, 4 numbers per pixel.
    pub rgba: Vec<f32>,
    /// Of each pixel: the standard deviation of its samples, in red, green and blue together (STE algorithm 1).
    pub deviations: Vec<f32>,
}

/// A little more than the least radius, so that the farthest sample weighs something too.
const BEYOND: f64 = 1.01;

impl Level {
    /// Of rays, with a kernel.
    pub fn new(samples: Samples, kernel: Kernel) -> Self {
        let [width, height] = samples.size();
        let pixels: Vec<[u32; 2]> = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
        let reach = |&pixel: &[u32; 2]| samples.reach(pixel, kernel.least);
        let radius = BEYOND * pixels.par_iter().map(reach).reduce(|| 0.0, f64::max);
        let lists: Vec<Vec<(u32, f32)>> =
            pixels.par_iter().map(|&pixel| weights(&samples, pixel, radius, kernel.falloff)).collect();
        let mut starts = vec![0];
        starts.extend(lists.iter().scan(0, |end, list| {
            *end += list.len() as u32;
            Some(*end)
        }));
        Self { radius, starts, rays: lists.concat(), samples }
    }

    /// Its rays.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// The radius of the kernel, pixels.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The rays of a pixel, with their weights.
    pub fn rays(&self, pixel: usize) -> &[(u32, f32)] {
        &self.rays[self.starts[pixel] as usize..self.starts[pixel + 1] as usize]
    }

    /// The picture, of what its rays find.
    pub fn reconstruct(&self, found: &[[f32; CHANNELS]]) -> Reconstructed {
        let pixels = self.starts.len() - 1;
        let mut made = Reconstructed { rgba: Vec::with_capacity(CHANNELS * pixels), deviations: Vec::new() };
        for pixel in 0..pixels {
            let (mean, deviation) = weighted(self.rays(pixel), found);
            made.rgba.extend(mean);
            made.deviations.push(deviation);
        }
        made
    }
}

/// The rays of a pixel and their weights.
fn weights(samples: &Samples, pixel: [u32; 2], radius: f64, falloff: f64) -> Vec<(u32, f32)> {
    let (mut rays, least) = (Vec::new(), (-falloff).exp());
    samples.around(pixel, radius, &mut |ray, square| {
        let weight = (-falloff * square / (radius * radius)).exp() - least;
        if weight > 0.0 {
            rays.push((ray, weight as f32));
        }
    });
    let mut distance = 2.0 * radius;
    while rays.is_empty() {
        let mut nearest = (f64::INFINITY, 0);
        samples.around(pixel, distance, &mut |ray, square| {
            if square < nearest.0 {
                nearest = (square, ray);
            }
        });
        rays.extend((nearest.0 < f64::INFINITY).then_some((nearest.1, 1.0)));
        distance *= 2.0;
    }
    rays
}

/// The weighted mean of some rays, and their standard deviation: one after the other, as West 1979 does, whom STE's
/// algorithm 1 cites (its line 12 differs from him, and is wrong).
fn weighted(rays: &[(u32, f32)], found: &[[f32; CHANNELS]]) -> ([f32; CHANNELS], f32) {
    let (mut sum, mut mean, mut squares) = (0.0, [0.0; CHANNELS], 0.0);
    for &(ray, weight) in rays {
        let before = sum;
        sum += weight;
        for i in 0..CHANNELS {
            let apart = found[ray as usize][i] - mean[i];
            let step = apart * (weight / sum);
            mean[i] += step;
            squares += if i < 3 { before * apart * step } else { 0.0 };
        }
    }
    // A single one does not differ from itself.
    let count = rays.len() as f32;
    (mean, (squares / sum * count / (count - 1.0).max(1.0)).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::{Pattern, Torus, Wish};
    use super::*;

    const SIZE: [u32; 2] = [80, 60];
    const PARTS: u32 = 5;
    const KERNELS: [Kernel; 3] = [
        Kernel { least: 1, falloff: 8.0 },
        Kernel { least: 3, falloff: 2.0 },
        Kernel { least: 6, falloff: 0.5 },
    ];

    fn levels(kernel: Kernel) -> impl Iterator<Item = Level> {
        let wish = Wish { torus: Torus { edges: [4, 3] }, sites: 75, per_site: 128, seed: 1 };
        let pattern = Pattern::capacity_constrained(wish, 500).0;
        (0..5).map(move |depth| Level::new(Samples::new(&pattern, SIZE, PARTS, depth), kernel))
    }

    /// A fine picture of some function of x and y, in pixels, in every channel.
    fn fine(colour: impl Fn(f32, f32) -> f32) -> Vec<f32> {
        let [width, height] = SIZE.map(|along| along * PARTS);
        let along = |at: u32| (at as f32 + 0.5) / PARTS as f32;
        (0..width * height).flat_map(|at| [colour(along(at % width), along(at / width)); 4]).collect()
    }

    #[test]
    fn one_colour_is_reconstructed_to_the_bit_and_has_no_deviation() {
        let flat = fine(|_, _| 0.3);
        for level in KERNELS.into_iter().flat_map(levels) {
            let made = level.reconstruct(&level.samples().cast(&flat));
            assert!(made.rgba.iter().all(|&colour| colour == 0.3));
            assert!(made.deviations.iter().all(|&deviation| deviation == 0.0));
        }
    }

    #[test]
    fn every_pixel_has_its_samples_and_nothing_outside_the_picture() {
        for kernel in KERNELS {
            for level in levels(kernel) {
                let [width, height] = SIZE.map(f64::from);
                for pixel in 0..(SIZE[0] * SIZE[1]) as usize {
                    let place =
                        [pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]].map(|at| f64::from(at) + 0.5);
                    let rim = place[0].min(place[1]).min(width - place[0]).min(height - place[1]);
                    let rays = level.rays(pixel);
                    assert!(!rays.is_empty() && rays.iter().all(|ray| ray.1 > 0.0));
                    assert!(rim < level.radius() || rays.len() >= kernel.least, "{kernel:?} {pixel}");
                }
            }
        }
    }

    #[test]
    fn a_ramp_errs_less_than_it_rises_between_samples_and_less_at_finer_levels() {
        // From 0 to 1 over 80 pixels.
        let ramp = fine(|x, _| x / 80.0);
        let mut last = f64::INFINITY;
        for level in levels(Kernel { least: 3, falloff: 2.0 }) {
            let made = level.reconstruct(&level.samples().cast(&ramp)).rgba;
            let error = |at: usize| f64::from(made[4 * at]) - ((at as f64 % 80.0) + 0.5) / 80.0;
            let squares: f64 = (0..made.len() / 4).map(|at| error(at).powi(2)).sum();
            let rms = (squares / (made.len() / 4) as f64).sqrt();
            assert!(
                rms < 0.25 * level.samples().spacing() / 80.0,
                "{rms} at level {}",
                level.samples().depth()
            );
            assert!(rms < last);
            last = rms;
        }
    }

    #[test]
    fn means_and_deviations_are_those_of_their_weights() {
        let found = [[0.0; 4], [0.5; 4], [1.0; 4]];
        let (mean, deviation) = weighted(&[(0, 1.0), (1, 2.0), (2, 1.0)], &found);
        assert_eq!(mean, [0.5; 4]);
        // The weighted variance is 1/8 in each of three channels, times 3/2 for the sample.
        assert!((deviation - (3.0_f32 * 0.125 * 1.5).sqrt()).abs() < 1e-6, "{deviation}");
        assert_eq!(weighted(&[(2, 0.7)], &found), ([1.0; 4], 0.0));
    }
}
