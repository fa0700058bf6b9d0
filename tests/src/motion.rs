//! Sequences of frames, and how far pictures jump from one to the next.
//!
//! A change between two frames has two parts: what moves, and what pops. The step of a pixel is both; its pop is how far
//! the step stands out of those before and after it. The same in space: see [`crate::borders`].

use crate::draw::draw_with;
use crate::scenes;
use bricks::BrickSource;
use display_config::Display;
use glam::DQuat;
use optics::{Light, Optics};
use protocol::{FrameReport, FrameState, ProjectorImage};
use renderer::Renderer;
use renderer::output::{Picture, PictureRef};

/// Frames shown per second.
pub const FRAMES_PER_SECOND: f64 = 60.0;

/// A volume that comes nearer at a steady pace: it grows by the same factor in every frame, about the screen's centre.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// Length of its longest edge in the first frame, metres.
    pub from_m: f64,
    /// And in the last.
    pub to_m: f64,
    /// How it is turned.
    pub rotation: DQuat,
    /// Frames, 1/60 s apart.
    pub frames: u32,
}

impl Approach {
    /// The frames, complete ones.
    pub fn frames(
        &self,
        display: &Display,
        source: &dyn BrickSource,
        optics: &Optics,
        light: Light,
    ) -> Vec<FrameState> {
        let along = |index: u32| f64::from(index) / f64::from(self.frames.max(2) - 1);
        let length = |index| self.from_m * (self.to_m / self.from_m).powf(along(index));
        let frame = |index| {
            let place = scenes::placed(source, length(index), self.rotation);
            let time_s = f64::from(index) / FRAMES_PER_SECOND;
            FrameState { index, time_s, ..scenes::frame(display, place, optics.clone(), Some(light)) }
        };
        (0..self.frames).map(frame).collect()
    }
}

/// The first of some frames again and again: time passes, and nothing moves.
pub fn standing_still(frames: &[FrameState]) -> Vec<FrameState> {
    let stay =
        |frame: &FrameState| FrameState { index: frame.index, time_s: frame.time_s, ..frames[0].clone() };
    frames.iter().map(stay).collect()
}

/// Draws frames one after the other with one renderer, and hands on each with its account and its pictures.
pub fn draw_sequence(
    renderer: &mut Renderer,
    frames: &[FrameState],
    mut sink: impl FnMut(&FrameState, FrameReport, Vec<ProjectorImage>),
) {
    for frame in frames {
        let (images, report) = draw_with(renderer, frame);
        sink(frame, report, images);
    }
}

/// How far pixels change, linear colour and opacity: the largest of a pixel's four numbers counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The largest.
    pub max: f64,
    /// What 99.9 % stay within.
    pub p999: f64,
    /// Root of the mean square.
    pub rms: f64,
}

impl Spread {
    /// Of some numbers; 0 of none.
    pub fn of(mut numbers: Vec<f64>) -> Self {
        if numbers.is_empty() {
            return Self { max: 0.0, p999: 0.0, rms: 0.0 };
        }
        let rank = ((numbers.len() as f64 * 0.999).ceil() as usize).clamp(1, numbers.len()) - 1;
        let max = numbers.iter().copied().fold(0.0, f64::max);
        let rms = (numbers.iter().map(|n| n * n).sum::<f64>() / numbers.len() as f64).sqrt();
        Self { max, rms, p999: *numbers.select_nth_unstable_by(rank, f64::total_cmp).1 }
    }

    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self { max: self.max.max(other.max), p999: self.p999.max(other.p999), rms: self.rms.max(other.rms) }
    }
}

impl std::fmt::Display for Spread {
    /// In units of 1/255: root of the mean square, 99.9 % and the largest.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.2} / {:.2} / {:.2}", 255.0 * self.rms, 255.0 * self.p999, 255.0 * self.max)
    }
}

/// What each pixel changes by from `a` to `b`.
pub fn steps(a: &ProjectorImage, b: &ProjectorImage) -> Vec<f64> {
    assert_eq!((a.projector, a.rgba.len()), (b.projector, b.rgba.len()), "pictures of one projector");
    largest_of_four(&a.rgba, |i| f64::from(b.rgba[i]) - f64::from(a.rgba[i]))
}

/// What each pixel's change from `of[1]` to `of[2]` stands out by, from the mean of the changes before and after: a smooth
/// motion leaves little, a jump its whole height.
pub fn pops(of: [&ProjectorImage; 4]) -> Vec<f64> {
    let step = |k: usize, i: usize| f64::from(of[k + 1].rgba[i]) - f64::from(of[k].rgba[i]);
    largest_of_four(&of[0].rgba, |i| step(1, i) - 0.5 * (step(0, i) + step(2, i)))
}

fn largest_of_four(rgba: &[f32], number: impl Fn(usize) -> f64) -> Vec<f64> {
    let pixels = 0..rgba.len() / 4;
    pixels.map(|p| (4 * p..4 * p + 4).map(|i| number(i).abs()).fold(0.0, f64::max)).collect()
}

/// The largest of what consecutive pictures of one projector change by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Continuity {
    /// Steps: what moves and what pops.
    pub step: Spread,
    /// Pops alone.
    pub pop: Spread,
    /// Number in the sequence of the second picture of the largest pop.
    pub pops_at: usize,
}

/// Measures a sequence of four pictures or more. `counts(first, pixel)` tells whether a pixel of the pictures `first` to
/// `first + 3` is looked at: where a silhouette passes, a pixel jumps whatever the detail does.
pub fn continuity(images: &[ProjectorImage], counts: impl Fn(usize, usize) -> bool) -> Continuity {
    assert!(images.len() >= 4, "a pop is told from four pictures");
    let kept = |first, numbers: Vec<f64>| {
        let of = numbers.into_iter().enumerate().filter(|&(pixel, _)| counts(first, pixel));
        Spread::of(of.map(|(_, number)| number).collect())
    };
    let none = Spread::of(Vec::new());
    let mut found = Continuity { step: none, pop: none, pops_at: 0 };
    for (number, pair) in images.windows(2).enumerate() {
        // The first and the last step have no four pictures around them: the nearest four tell.
        let first = number.saturating_sub(1).min(images.len() - 4);
        found.step = found.step.max(kept(first, steps(&pair[0], &pair[1])));
    }
    for (first, w) in images.windows(4).enumerate() {
        let pop = kept(first, pops([&w[0], &w[1], &w[2], &w[3]]));
        if pop.max > found.pop.max {
            found.pops_at = first + 2;
        }
        found.pop = found.pop.max(pop);
    }
    found
}

/// A picture of what pixels differ by, `gain` times brighter.
pub fn difference(a: &ProjectorImage, b: &ProjectorImage, gain: f32) -> Picture {
    let pairs = a.rgba.chunks_exact(4).zip(b.rgba.chunks_exact(4));
    let pixel = |(p, q): (&[f32], &[f32])| {
        let [r, g, b] = [0, 1, 2].map(|i| gain * (q[i] - p[i]).abs());
        [r, g, b, 1.0]
    };
    Picture { width: a.width, height: a.height, rgba: pairs.flat_map(pixel).collect() }
}

/// A picture of a projector, to be written.
pub fn borrowed(image: &ProjectorImage) -> PictureRef<'_> {
    PictureRef::of(image).expect("a projector's picture has four numbers per pixel")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(value: f32) -> ProjectorImage {
        ProjectorImage {
            projector: 0,
            width: 2,
            height: 1,
            rgba: vec![0.0, 0.0, 0.0, 0.0, value, 0.0, 0.0, 0.0],
        }
    }

    #[test]
    fn a_steady_motion_steps_and_does_not_pop() {
        let images: Vec<_> = (0..8).map(|i| image(0.125 * i as f32)).collect();
        let found = continuity(&images, |_, _| true);
        assert_eq!((found.step.max, found.pop.max), (0.125, 0.0));
    }

    #[test]
    fn the_first_step_counts() {
        let images: Vec<_> = (0..8).map(|i| image(if i == 0 { 0.0 } else { 0.5 })).collect();
        assert_eq!(continuity(&images, |_, _| true).step.max, 0.5);
    }

    #[test]
    fn a_jump_pops_by_its_height_whatever_moves() {
        let images: Vec<_> =
            (0..8).map(|i| image(0.0625 * i as f32 + if i >= 5 { 0.25 } else { 0.0 })).collect();
        let found = continuity(&images, |_, _| true);
        assert_eq!((found.step.max, found.pop.max, found.pops_at), (0.3125, 0.25, 5));
    }
}
