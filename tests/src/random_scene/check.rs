//! A random scene drawn by every device and caster: light in every pixel, the same light by all, and near the truth.

use super::RandomScene;
use super::difference::{Difference, Limit, difference};
use super::judge::{Judge, Verdict};
use super::truth::{LIT, Truth};
use crate::draw::{self, With};
use crate::remembered::Remembered;
use bricks::BrickSource;
use display_config::Display;
use optics::Quality;
use protocol::{Caster, CasterChoice, FrameState, ProjectorImage};
use std::sync::Arc;

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// Odd, so that one column and one row look straight ahead.
const RASTER: [u32; 2] = [25, 19];
/// Pixels that show anything per one that is asked how sharply it is judged.
const SHARP_STRIDE: usize = 16;
/// A spoilt picture that differs on average by this much more than is allowed must be found out.
const CANARY_MARGIN: f64 = 1.5;
/// Opacities are composited in f32: a few hundred steps of 1e-7 each.
const OPACITY_ROUNDING: f32 = 1e-5;

/// What came of a scene.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The GPU against the twin.
    pub rounding: Option<Difference>,
    /// Pixels whose truth is known, and those of which it is not.
    pub truth: Option<[usize; 2]>,
    /// Rays by every device against the truth.
    pub by_rays: Vec<Verdict>,
    /// Row planes against the truth, where they draw the scene.
    pub by_planes: Option<Verdict>,
    /// Of some pixels that show anything, those of which a fault of a code would be seen, and all.
    pub sharp: [usize; 2],
    /// Pixels that show anything.
    pub lit: usize,
    /// What is wrong, a sentence each.
    pub wrong: Vec<String>,
}

/// Kernel and twin. Both round to f32 and take the same steps: a thousand rounded additions. Where a length sits on a whole
/// number of steps, or an estimate on a whole number of parts, one takes one more, and the pixel differs by a part of what
/// the integration errs there. The texture unit is asked at points rounded to 1/4096 texel: a steep transfer function
/// makes that visible, and where something opaque has an outline a pixel shows it or does not. Bent rays turn by rounded
/// gradients at every pair of steps, so that their ways drift apart: of 2,000 random scenes three, all with
/// bent light, had a mean of 0.0041, 0.0048 and 0.0081 codes, and one of them a pixel in 430 beyond a code.
fn limit_of_rounding(scene: &RandomScene) -> Limit {
    match (scene.is_tame(), scene.optics.refraction.is_some()) {
        (true, false) => Limit { pixel: 1.0 / 255.0, share: 0.0, mean: 0.004 / 255.0 },
        (true, true) => Limit { pixel: 1.0 / 255.0, share: 0.005, mean: 0.02 / 255.0 },
        (false, _) => Limit { pixel: 1.0 / 255.0, share: 0.01, mean: 0.05 / 255.0 },
    }
}

/// The display that random scenes are drawn on.
pub fn display() -> Display {
    Display::load("desk8").expect("a preset").with_rasters(RASTER[0], RASTER[1])
}

/// Row planes where they can draw a scene, rays elsewhere.
const PLANES_OR_RAYS: With = With { caster: CasterChoice::Auto, ..With::PLANES };

/// Draws a scene in every way there is, and compares.
pub fn check(display: &Display, scene: &RandomScene) -> Found {
    let source: Arc<dyn BrickSource> = Arc::new(Remembered::new(scene.volume.source()));
    let frame = FrameState { welcomes_planes: true, ..scene.frame(display) };
    let mut found = Found::default();
    let mut all: Vec<(With, Vec<ProjectorImage>)> = Vec::new();
    for with in draw::devices().into_iter().map(With::device).chain([PLANES_OR_RAYS]) {
        let drawn = draw::draw(display, &frame, &source, &PROJECTORS, with);
        if with.caster == CasterChoice::Auto && !matches!(drawn.report.caster, Caster::Planes { .. }) {
            continue;
        }
        if !drawn.report.complete {
            found.wrong.push(format!("{}: {}", name(with), drawn.report.shortfall));
        }
        found.wrong.extend(what_is_no_light(&drawn.images).map(|what| format!("{}: {what}", name(with))));
        all.push((with, drawn.images));
    }
    let by_rays: Vec<_> = all.iter().filter(|(with, _)| with.caster == CasterChoice::Rays).collect();
    // Where rays are bent much, those that differ by rounding part.
    if let [(_, twin), (_, kernel)] = &by_rays[..]
        && scene.is_gentle
    {
        found.compare_kernel(scene, kernel, twin);
    }
    found.lit = all.iter().flat_map(|(_, images)| numbers(images)).filter(|p| p[3] > LIT).count() / all.len();
    if scene.has_truth() && found.lit > 0 {
        let truth = Truth::new(display, &frame, &source, &PROJECTORS, 1);
        let judge = Judge::new(&truth, 1.0 / brightest(scene), &scene.quality);
        found.truth = Some(truth.known());
        found.sharp = judge.sharp(SHARP_STRIDE);
        for (with, images) in all {
            let again = |quality: Quality| {
                let frame = FrameState { quality, ..frame.clone() };
                draw::draw(display, &frame, &source, &PROJECTORS, with).images
            };
            let verdict = judge.judge(&images, again);
            if with.caster != CasterChoice::Rays {
                found.by_planes = Some(verdict);
                continue;
            }
            if !verdict.holds() {
                found.wrong.push(format!("{} off the truth: {verdict}", name(with)));
            }
            found.by_rays.push(verdict);
        }
    }
    found
}

fn name(with: With) -> String {
    let caster = if with.caster == CasterChoice::Rays { "rays" } else { "row planes" };
    format!("{caster} by {:?}", with.device)
}

impl Found {
    fn compare_kernel(&mut self, scene: &RandomScene, kernel: &[ProjectorImage], twin: &[ProjectorImage]) {
        let (limit, scale) = (limit_of_rounding(scene), 1.0 / brightest(scene));
        let kernel = || numbers(kernel);
        let found = difference(kernel().zip(numbers(twin)), scale, limit.pixel);
        if !limit.holds(&found) {
            self.wrong.push(format!("kernel and twin differ: {found}"));
        }
        self.rounding = Some(found);
        // The canary: a thousandth more light, where that is more than is allowed on average.
        let brighter = difference(kernel().map(|p| p.map(|n| 1.001 * n)).zip(kernel()), scale, limit.pixel);
        if 1e-3 * mean_light(kernel(), scale) > CANARY_MARGIN * limit.mean && limit.holds(&brighter) {
            self.wrong.push("a picture brighter by a thousandth passes for the twin's".into());
        }
    }
}

/// The mean of all numbers of some pixels, times `scale`.
fn mean_light(pixels: impl Iterator<Item = [f64; 4]>, scale: f64) -> f64 {
    let (sum, count) = pixels.fold((0.0, 0), |(sum, count), p| (sum + p.iter().sum::<f64>(), count + 4));
    scale * sum / f64::from(count.max(1))
}

/// The first number that is no light, if any.
fn what_is_no_light(images: &[ProjectorImage]) -> Option<String> {
    let numbers = || images.iter().flat_map(|image| &image.rgba);
    let wrong = numbers().find(|n| !(n.is_finite() && **n >= 0.0)).map(|n| format!("{n} is no light"));
    let opacity = numbers().skip(3).step_by(4).find(|opacity| **opacity > 1.0 + OPACITY_ROUNDING);
    wrong.or(opacity.map(|opacity| format!("an opacity of {opacity}")))
}

/// The most that a number of a pixel may be, at least 1.
fn brightest(scene: &RandomScene) -> f64 {
    let colour = scene.optics.colour.points().iter().map(|p| p.1.max_element()).fold(1.0, f64::max);
    let Some(light) = &scene.light else { return colour };
    let materials = scene.optics.materials.iter().flat_map(|m| m.points()).map(|p| p.1);
    let lit = |m: optics::Material| colour * (m.ambient + m.diffuse).max(1.0) + m.specular;
    materials.map(lit).fold(lit(light.material()), f64::max)
}

fn numbers(images: &[ProjectorImage]) -> impl Iterator<Item = [f64; 4]> {
    images
        .iter()
        .flat_map(|image| image.rgba.chunks_exact(4))
        .map(|p| std::array::from_fn(|c| f64::from(p[c])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_has_no_numbers_below_zero_and_no_opacity_above_one() {
        let picture =
            |rgba: [f32; 4]| ProjectorImage { projector: 0, width: 1, height: 1, rgba: rgba.to_vec() };
        assert_eq!(what_is_no_light(&[picture([3.0, 0.0, 1.0, 1.0])]), None);
        for wrong in [[-1e-9, 0.0, 0.0, 0.5], [0.0, f32::INFINITY, 0.0, 0.5], [0.0, 0.0, 0.0, 1.001]] {
            assert!(what_is_no_light(&[picture(wrong)]).is_some(), "{wrong:?}");
        }
    }
}
