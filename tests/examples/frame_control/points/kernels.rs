//! Which Gaussian is best for which density of samples: the paper gives none.

use super::shots::{Shots, Truth};
use lightloom_tests::points::{Kernel, Level, Pattern, Samples};
use lightloom_tests::results::Results;
use rayon::prelude::*;

/// All that are tried, and those that are where pictures are large.
pub const ALL: (&[usize], &[f64]) = (&[1, 2, 3, 4, 6], &[0.5, 1.0, 2.0, 4.0, 8.0]);
pub const FEW: (&[usize], &[f64]) = (&[2, 3, 4], &[2.0, 4.0]);

/// The best kernels, by rays for each pixel.
pub struct Kernels(Vec<(f64, Kernel)>);

impl Kernels {
    /// Tries some on levels, given by a pattern and a depth: by the mean RMS over all shots.
    pub fn best(
        results: &mut Results,
        shots: &[Shots],
        size: [u32; 2],
        (least, falloffs): (&[usize], &[f64]),
        levels: &[(&Pattern, u32)],
    ) -> Self {
        results.line("| rays a pixel | samples a pixel has at least | α r² | r, distances between samples | RMS | of the worst kernel |");
        results.line("| ---: | ---: | ---: | ---: | ---: | ---: |");
        let mut best = Vec::new();
        for &(pattern, depth) in levels {
            let samples = Samples::new(pattern, size, shots[0].parts(), depth);
            let kernels: Vec<Kernel> = least
                .iter()
                .flat_map(|&least| falloffs.iter().map(move |&falloff| Kernel { least, falloff }))
                .collect();
            let tried = |&kernel: &Kernel| {
                let level = Level::new(samples.clone(), kernel);
                (mean_rms(&level, shots), level.radius() / samples.spacing(), kernel)
            };
            let mut tried: Vec<(f64, f64, Kernel)> = kernels.par_iter().map(tried).collect();
            tried.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (rms, radius, kernel) = tried[0];
            let density = samples.spacing().powi(-2);
            results.line(format!(
                "| {density:.4} | {} | {} | {radius:.2} | {:.2} | {:.2} |",
                kernel.least,
                kernel.falloff,
                255.0 * rms,
                255.0 * tried[tried.len() - 1].0,
            ));
            best.push((density, kernel));
        }
        results.line("");
        Self(best)
    }

    /// A level with the kernel that is best for about so many samples.
    pub fn level(&self, pattern: &Pattern, size: [u32; 2], parts: u32, depth: u32) -> Level {
        let samples = Samples::new(pattern, size, parts, depth);
        let density = samples.spacing().powi(-2);
        let apart = |known: &&(f64, Kernel)| (known.0 / density).ln().abs();
        let nearest = self.0.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        Level::new(samples, nearest.expect("some were tried").1)
    }
}

/// The mean over all shots of what a level alone errs.
fn mean_rms(level: &Level, shots: &[Shots]) -> f64 {
    let all = shots.iter().flat_map(|shots| (0..shots.count()).map(move |instant| (shots, instant)));
    let errors: Vec<f64> = all
        .map(|(shots, instant)| {
            let should = shots.complete(instant, Truth::Middles);
            let made: Vec<Vec<f32>> =
                shots.fine(instant).map(|fine| level.reconstruct(&level.samples().cast(fine)).rgba).collect();
            shots.rms(&shots.seen(&made), &shots.seen(&should))
        })
        .collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}
