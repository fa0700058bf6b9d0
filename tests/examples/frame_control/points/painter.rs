//! What a machine casts and shows of an instant: lattices of pixels, or points.

use frontend::tune::Footage;
use lightloom_tests::points::{Reconstructed, Schedule};
use protocol::ProjectorImage;
use renderer::refine::{ERROR_UNIT, Filled, Order, UNITS, change_at, fill, sparse};
use std::sync::Arc;

/// Casts units of an instant, one after the other, and shows what it has.
pub trait Painter {
    /// Units of a complete picture.
    fn units(&self) -> u32;
    /// What some units cost, of what one ray a pixel does: those up to `to`, of which `from` are cast.
    fn cost(&self, from: u32, to: u32) -> f64;
    /// The same of a look at another state.
    fn look(&self) -> f64;
    /// Begins anew.
    fn begin(&mut self);
    /// Makes the pictures of an instant of which so many units are cast; their ζ.
    fn paint(&mut self, instant: usize, done: u32) -> f64;
    /// The pictures.
    fn pictures(&self) -> Vec<&[f32]>;
    /// τ between two instants.
    fn change(&self, now: usize, before: usize) -> f64;
}

/// Lattices of pixels that are filled.
pub struct Lattices<'a> {
    footage: &'a Footage,
    order: &'a Order,
    /// Whether pixels are also made from the picture before.
    has_past: bool,
    filled: Vec<Filled>,
    before: Vec<Filled>,
}

impl<'a> Lattices<'a> {
    /// Nothing is cast yet.
    pub fn new(footage: &'a Footage, order: &'a Order, has_past: bool) -> Self {
        Self { footage, order, has_past, filled: Vec::new(), before: Vec::new() }
    }
}

impl Painter for Lattices<'_> {
    fn units(&self) -> u32 {
        UNITS
    }

    fn cost(&self, from: u32, to: u32) -> f64 {
        f64::from(to - from) / f64::from(UNITS)
    }

    fn look(&self) -> f64 {
        self.cost(0, 1)
    }

    fn begin(&mut self) {
        self.before = std::mem::take(&mut self.filled);
        if !self.has_past {
            self.before.clear();
        }
    }

    fn paint(&mut self, instant: usize, done: u32) -> f64 {
        let images = self.footage.pictures(instant);
        self.filled.resize_with(images.len(), Filled::default);
        for (view, (image, filled)) in images.iter().zip(&mut self.filled).enumerate() {
            let last = std::mem::take(filled);
            *filled = fill(image.rgba.clone(), self.before.get(view), last, self.order, done);
        }
        let pixels: usize = self.filled.iter().map(|one| one.rgba.len() / 4).sum();
        self.filled.iter().map(|one| one.spatial).sum::<u64>() as f64 * ERROR_UNIT / pixels.max(1) as f64
    }

    fn pictures(&self) -> Vec<&[f32]> {
        self.filled.iter().map(|one| &one.rgba[..]).collect()
    }

    fn change(&self, now: usize, before: usize) -> f64 {
        let seen =
            |image: &ProjectorImage| sparse(&image.rgba, [image.width, image.height], self.order.first());
        let pairs = self.footage.pictures(now).iter().zip(self.footage.pictures(before));
        let (sum, count) = pairs.fold((0, 0), |(sum, count), (now, before)| {
            let (now, before) = (seen(now), seen(before));
            (sum + change_at(&now, &before), count + now.len())
        });
        sum as f64 * ERROR_UNIT / count.max(1) as f64
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

    fn look(&self) -> f64 {
        self.cost(0, 1)
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
