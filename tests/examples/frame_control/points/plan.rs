//! Ways to a picture, with some rays for each pixel.

use super::kernels::Kernels;
use super::patterns::Patterns;
use super::shots::{Shots, Truth};
use lightloom_tests::points::{Level, Pattern, Reconstructed, Schedule};
use renderer::refine::{self, Grain, Order, UNITS, fill};

/// Rays for each pixel, of those that a complete picture of ours has.
pub const SHARES: [f64; 5] = [1.0 / 64.0, 1.0 / 16.0, 0.25, 0.5, 1.0];
/// Opacity rises over so many distances between samples of the coarser level.
pub const BORDER: f64 = 1.0;

/// A way to a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Pixels of lattices, filled in space.
    Filled,
    /// Points, from the coarsest level on, as the paper does.
    Levels,
    /// Points of one level alone, as if somebody had known how many there would be.
    AtOnce,
    /// The same with a ray in each cell of a grid.
    Jittered,
}

/// All ways for a raster.
pub struct Plan {
    order: Order,
    schedule: Schedule,
    at_once: Vec<Level>,
    jittered: Vec<Option<Level>>,
}

/// Pictures of all views, and how many rays they took for each pixel.
pub type Made = (Vec<Vec<f32>>, f64);

impl Plan {
    /// The points' levels are those of a pattern, down to a depth. A picture of `size` has 4^`deeper` times the pixels that
    /// the even patterns are for.
    pub fn new(
        (size, parts): ([u32; 2], u32),
        (pattern, depth): (&Pattern, u32),
        deeper: u32,
        patterns: &Patterns,
        (kernels, jittered): (&Kernels, Option<&Kernels>),
    ) -> Self {
        let levels = (0..=depth).map(|depth| kernels.level(pattern, size, parts, depth)).collect();
        // 300 × 4^l rays, and 150 × 4^l.
        let exact = [(0, 0), (0, 1), (0, 2), (1, 3), (0, 3)].map(|(which, depth)| (which, depth + deeper));
        let at_once = exact.map(|(which, depth)| kernels.level(&patterns.even[which], size, parts, depth));
        let jittered = exact.map(|(which, depth)| {
            let kernels = jittered.filter(|_| which == 0)?;
            Some(kernels.level(&patterns.jittered, size, parts, depth))
        });
        Self {
            order: Order::new(Grain::Pixels, size),
            schedule: Schedule::new(levels, BORDER),
            at_once: at_once.into(),
            jittered: jittered.into(),
        }
    }

    /// The points' levels.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn pixels(&self) -> f64 {
        f64::from(self.order.size()[0] * self.order.size()[1])
    }

    /// What the levels of the points show of each view.
    pub fn levels(&self, shots: &Shots, instant: usize) -> Vec<Vec<Reconstructed>> {
        let of = |fine| {
            let each = self.schedule.levels().iter();
            each.map(|level| level.reconstruct(&level.samples().cast(fine))).collect()
        };
        shots.fine(instant).map(of).collect()
    }

    /// Pictures of a share of the rays; None if this way has none.
    pub fn made(
        &self,
        (shots, instant): (&Shots, usize),
        levels: &[Vec<Reconstructed>],
        way: Way,
        share: usize,
    ) -> Option<Made> {
        match way {
            Way::Filled => {
                let done = (SHARES[share] * f64::from(UNITS)) as u32;
                let cast =
                    (0..self.pixels() as usize).filter(|&pixel| self.order.is_cast(pixel, done)).count();
                let complete = shots.complete(instant, Truth::Middles).into_iter();
                let filled = complete
                    .map(|picture| fill(picture, None, refine::Filled::default(), &self.order, done).rgba);
                Some((filled.collect(), cast as f64 / self.pixels()))
            }
            Way::Levels => {
                let done = self.schedule.affordable((SHARES[share] * self.pixels()) as u64);
                (done > 0).then(|| self.refined(levels, done))
            }
            Way::AtOnce => Some(self.alone(&self.at_once[share], shots, instant)),
            Way::Jittered => self.jittered[share].as_ref().map(|level| self.alone(level, shots, instant)),
        }
    }

    /// Pictures of so many tiles.
    pub fn refined(&self, levels: &[Vec<Reconstructed>], done: usize) -> Made {
        let mix = self.schedule.mix(done);
        (
            levels.iter().map(|levels| mix.of(levels).rgba).collect(),
            self.schedule.rays(done) as f64 / self.pixels(),
        )
    }

    fn alone(&self, level: &Level, shots: &Shots, instant: usize) -> Made {
        let made = shots.fine(instant).map(|fine| level.reconstruct(&level.samples().cast(fine)).rgba);
        (made.collect(), level.samples().count() as f64 / self.pixels())
    }
}
