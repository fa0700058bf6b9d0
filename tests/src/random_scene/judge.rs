//! Pictures judged pixel by pixel, each by what its quality promises and by its own condition.

use super::truth::{LIT, Truth, numbers};
use optics::Quality;
use protocol::ProjectorImage;
use rayon::prelude::*;
use std::fmt;

/// What quality promises, besides the light that a ray may end without: a pair of steps errs by its tolerance, and the light of
/// a ray comes from so many pairs. Half a code at default quality.
const PAIRS: f64 = 20.0;
/// How many times as far as by one perturbation rounding may take a pixel: four directions are tried of all there are, and
/// samples along a ray are moved each by its own rounding.
const MOST_OF_CONDITION: f64 = 4.0;
/// A code.
const CODE: f64 = 1.0 / 255.0;
/// How much shorter steps are where it is asked whether they were too long: by the second, if the first is not enough.
const SHORTER: [f64; 2] = [4.0, 16.0];
/// Share of the pixels that may be off their limit, whatever the steps: a table has 1023 cells, and where extinction jumps or
/// bends within one of them, a pixel whose scalars stay in that cell shows what lies beyond.
const WRONG: f64 = 0.002;
/// Share of the pixels that may be off their limit until steps are shorter: a quarter above the most of any of 1,360 scenes.
const UNSEEN: f64 = 0.05;
/// Share of the pixels that may be excused by their condition: a fifth above the most of any of them.
const ILL: f64 = 0.17;

/// What judges pictures of a scene.
pub struct Judge<'a> {
    truth: &'a Truth,
    /// 1 / the brightest that a pixel may be.
    scale: f64,
    quality: Quality,
}

/// A picture against the truth: pixels of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Verdict {
    /// Compared.
    pub pixels: usize,
    /// Beyond what quality promises, within what rounding does to them.
    pub ill: usize,
    /// Beyond both, but not where steps are a quarter or a sixteenth as long: something lay unseen between two samples, or
    /// bent light grazed a surface.
    pub unseen: usize,
    /// Beyond both at all steps.
    pub wrong: usize,
    /// The mean error, share of the brightest.
    pub mean: f64,
    /// The largest.
    pub max: f64,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { pixels, ill, unseen, wrong, mean, max } = self;
        let (mean, max) = (255.0 * mean, 255.0 * max);
        write!(f, "mean {mean:.4}, max {max:.3} (of 255); of {pixels} pixels {ill} ill-conditioned, ")?;
        write!(f, "{unseen} right by shorter steps alone, {wrong} wrong")
    }
}

impl Verdict {
    /// Pixels beyond promise and condition.
    pub fn off(&self) -> usize {
        self.unseen + self.wrong
    }

    /// Both pictures together.
    pub fn and(&self, other: &Self) -> Self {
        let pixels = self.pixels + other.pixels;
        let light = |v: &Self| v.mean * v.pixels as f64;
        Self {
            pixels,
            ill: self.ill + other.ill,
            unseen: self.unseen + other.unseen,
            wrong: self.wrong + other.wrong,
            mean: (light(self) + light(other)) / pixels.max(1) as f64,
            max: self.max.max(other.max),
        }
    }

    /// Whether the picture is the truth's.
    pub fn holds(&self) -> bool {
        let most = |share: f64| (share * self.pixels as f64).ceil() as usize;
        self.wrong <= most(WRONG) && self.unseen <= most(UNSEEN) && self.ill <= most(ILL)
    }
}

impl<'a> Judge<'a> {
    /// Of pictures drawn at `quality`, of which no number is beyond 1 / `scale`.
    pub fn new(truth: &'a Truth, scale: f64, quality: &Quality) -> Self {
        Self { truth, scale, quality: *quality }
    }

    /// Pixels that are compared.
    fn pixels(&self) -> usize {
        self.truth.pixels.len()
    }

    /// The verdict on a picture; `again` draws it at another quality.
    pub fn judge(
        &self,
        images: &[ProjectorImage],
        again: impl Fn(Quality) -> Vec<ProjectorImage>,
    ) -> Verdict {
        let errors = self.errors(images);
        let [ill, off] = self.parted(&errors);
        let mut wrong = off.clone();
        for shorter in SHORTER {
            if !wrong.is_empty() {
                let closer = again(closer(&self.quality, shorter));
                wrong.retain(|&i| self.error(&closer, i) > self.limit(i));
            }
        }
        let wrong = wrong.len();
        Verdict {
            pixels: errors.len(),
            ill: ill.len(),
            unseen: off.len() - wrong,
            wrong,
            mean: errors.iter().sum::<f64>() / errors.len().max(1) as f64,
            max: errors.iter().copied().fold(0.0, f64::max),
        }
    }

    /// The pixels beyond what quality promises: those within what rounding does to them, and all others.
    pub fn beyond(&self, images: &[ProjectorImage]) -> [Vec<usize>; 2] {
        self.parted(&self.errors(images))
    }

    fn errors(&self, images: &[ProjectorImage]) -> Vec<f64> {
        (0..self.pixels()).map(|i| self.error(images, i)).collect()
    }

    /// See [`Judge::beyond`].
    fn parted(&self, errors: &[f64]) -> [Vec<usize>; 2] {
        let beyond: Vec<usize> = (0..errors.len()).filter(|&i| errors[i] > self.promise()).collect();
        let (ill, off) = beyond.into_par_iter().partition(|&i| errors[i] <= self.limit(i));
        [ill, off]
    }

    /// Of every `stride`-th pixel that shows anything, those whose limit is below a code, and all.
    pub fn sharp(&self, stride: usize) -> [usize; 2] {
        let shows = |i: &usize| self.truth.pixels[*i].truth.opacity > LIT;
        let some: Vec<usize> = (0..self.pixels()).filter(shows).step_by(stride).collect();
        [some.par_iter().filter(|&&i| self.limit(i) < CODE).count(), some.len()]
    }

    fn promise(&self) -> f64 {
        PAIRS * self.quality.tolerance + self.quality.termination
    }

    fn limit(&self, index: usize) -> f64 {
        self.promise() + MOST_OF_CONDITION * self.scale * self.truth.condition(index)
    }

    /// The error of a pixel's worst number; a NaN is farther off than anything.
    fn error(&self, images: &[ProjectorImage], index: usize) -> f64 {
        let pixel = &self.truth.pixels[index];
        let image = images.iter().find(|image| image.projector == pixel.projector);
        let image = image.expect("every projector with truth has a picture");
        let at = 4 * (pixel.y as usize * image.width as usize + pixel.x as usize);
        let truth = numbers(&pixel.truth);
        let off = |c: usize| self.scale * (f64::from(image.rgba[at + c]) - truth[c]).abs();
        (0..4).map(off).fold(0.0, |worst, d| if d.is_nan() { f64::INFINITY } else { worst.max(d) })
    }
}

/// Quality by which a second-order error falls with the square of `shorter`.
fn closer(quality: &Quality, shorter: f64) -> Quality {
    let square = shorter * shorter;
    Quality {
        step_voxels: (quality.step_voxels / shorter).max(Quality::STEPS_VOXELS.0),
        tolerance: (quality.tolerance / square).max(Quality::LEAST_TOLERANCE),
        termination: quality.termination / square,
        ..*quality
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques;
    use display_config::Display;

    #[test]
    fn the_truth_holds_and_a_code_more_or_a_nan_does_not() {
        let display = Display::load("desk8").unwrap().with_rasters(9, 7);
        let scene = techniques::bumps(&display);
        let truth = Truth::new(&display, &scene.frame, &scene.source, &[5], 1);
        let judge = Judge::new(&truth, 1.0, &scene.frame.quality);
        let verdict = |more: f32| {
            let rgba = truth.pixels.iter().flat_map(|pixel| numbers(&pixel.truth)).map(|n| n as f32 + more);
            let images = [ProjectorImage { projector: 5, width: 9, height: 7, rgba: rgba.collect() }];
            judge.judge(&images, |_| images.to_vec())
        };
        assert_eq!((verdict(0.0).holds(), verdict(0.0).off()), (true, 0));
        let [sharp, lit] = judge.sharp(1);
        assert!(sharp > 0 && 10 * sharp >= 9 * lit, "{sharp} of {lit}");
        for more in [1.0 / 255.0, f32::NAN] {
            let found = verdict(more);
            assert!(!found.holds() && found.wrong >= sharp, "{more}: {found}");
        }
    }
}
