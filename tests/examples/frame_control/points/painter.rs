//! What a machine casts and shows of an instant: lattices of pixels in space alone, or points.

use frontend::tune::{Footage, Lattices, Painter};
use lightloom_tests::points::{Reconstructed, Schedule};
use std::sync::Arc;

/// Lattices of pixels that are filled in space alone: nothing is made from the picture before.
pub struct InSpaceAlone<'a> {
    footage: &'a Footage,
    lattices: Lattices<'a>,
}

impl<'a> InSpaceAlone<'a> {
    /// Nothing is cast yet.
    pub fn new(footage: &'a Footage) -> Self {
        Self { footage, lattices: Lattices::new(footage) }
    }
}

impl Painter for InSpaceAlone<'_> {
    fn units(&self) -> u32 {
        self.lattices.units()
    }

    fn cost(&self, from: u32, to: u32) -> f64 {
        self.lattices.cost(from, to)
    }

    fn begin(&mut self) {
        self.lattices = Lattices::new(self.footage);
    }

    fn paint(&mut self, instant: usize, done: u32) -> f64 {
        self.lattices.paint(instant, done)
    }

    fn pictures(&self) -> Vec<&[f32]> {
        self.lattices.pictures()
    }

    fn change(&self, now: usize, before: usize) -> f64 {
        self.lattices.change(now, before)
    }
}

/// What the levels of the points show of an instant: for each view a picture for each level.
pub type Levels = Arc<Vec<Vec<Reconstructed>>>;

/// Points, level after level; a unit is a tile.
pub struct Points<'a> {
    pub schedule: &'a Schedule,
    /// Of each instant.
    pub levels: &'a [Levels],
    pub shown: Vec<Reconstructed>,
}

impl Painter for Points<'_> {
    fn units(&self) -> u32 {
        self.schedule.tiles() as u32
    }

    fn cost(&self, from: u32, to: u32) -> f64 {
        let [columns, rows] = self.schedule.levels()[0].samples().size();
        let rays = self.schedule.rays(to as usize) - self.schedule.rays(from as usize);
        rays as f64 / f64::from(columns * rows)
    }

    fn begin(&mut self) {}

    fn paint(&mut self, instant: usize, done: u32) -> f64 {
        let mix = self.schedule.mix(done as usize);
        self.shown = self.levels[instant].iter().map(|levels| mix.of(levels)).collect();
        let deviations = self.shown.iter().flat_map(|one| &one.deviations);
        let pixels: usize = self.shown.iter().map(|one| one.deviations.len()).sum();
        deviations.map(|&deviation| f64::from(deviation)).sum::<f64>() / pixels.max(1) as f64
    }

    fn pictures(&self) -> Vec<&[f32]> {
        self.shown.iter().map(|one| &one.rgba[..]).collect()
    }

    fn change(&self, now: usize, before: usize) -> f64 {
        let views = self.levels[now].iter().zip(&*self.levels[before]);
        let pixels =
            views.flat_map(|(now, before)| now[0].rgba.chunks_exact(4).zip(before[0].rgba.chunks_exact(4)));
        let distance = |(a, b): (&[f32], &[f32])| {
            f64::from((0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f32>().sqrt())
        };
        let (sum, count) = pixels.fold((0.0, 0.0), |(sum, count), pair| (sum + distance(pair), count + 1.0));
        sum / f64::max(count, 1.0)
    }
}
