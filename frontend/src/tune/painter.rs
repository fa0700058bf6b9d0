//! What a machine casts and shows of an instant.

use super::Footage;
use protocol::ProjectorImage;
use renderer::refine::{ERROR_UNIT, Filled, Grain, Order, UNITS, change_at, fill, sparse};

/// Casts units of an instant, one after the other, and shows what it has.
pub trait Painter {
    /// Units of a complete picture.
    fn units(&self) -> u32;
    /// What some units cost, of what one ray a pixel does: those up to `to`, of which `from` are cast.
    fn cost(&self, from: u32, to: u32) -> f64;
    /// Begins anew.
    fn begin(&mut self);
    /// Makes the pictures of an instant of which so many units are cast; their ζ.
    fn paint(&mut self, instant: usize, done: u32) -> f64;
    /// The pictures.
    fn pictures(&self) -> Vec<&[f32]>;
    /// τ between two instants. Its rays are those of the first unit.
    fn change(&self, now: usize, before: usize) -> f64;
}

/// Lattices of pixels that are filled in space and time.
pub struct Lattices<'a> {
    footage: &'a Footage,
    order: Order,
    /// What was made of each picture last, and what of those of the configuration before.
    filled: Vec<Filled>,
    before: Vec<Filled>,
}

impl<'a> Lattices<'a> {
    /// Nothing is cast yet.
    pub fn new(footage: &'a Footage) -> Self {
        let picture = &footage.pictures(0)[0];
        let order = Order::new(Grain::Pixels, [picture.width, picture.height]);
        Self { footage, order, filled: Vec::new(), before: Vec::new() }
    }
}

impl Painter for Lattices<'_> {
    fn units(&self) -> u32 {
        UNITS
    }

    fn cost(&self, from: u32, to: u32) -> f64 {
        f64::from(to - from) / f64::from(UNITS)
    }

    fn begin(&mut self) {
        self.before = std::mem::take(&mut self.filled);
    }

    fn paint(&mut self, instant: usize, done: u32) -> f64 {
        let images = self.footage.pictures(instant);
        self.filled.resize_with(images.len(), Filled::default);
        for (view, (image, filled)) in images.iter().zip(&mut self.filled).enumerate() {
            let last = std::mem::take(filled);
            *filled = fill(image.rgba.clone(), self.before.get(view), last, &self.order, done);
        }
        let pixels: usize = self.filled.iter().map(|one| one.rgba.len() / 4).sum();
        self.filled.iter().map(|one| one.spatial).sum::<u64>() as f64 * ERROR_UNIT / pixels.max(1) as f64
    }

    fn pictures(&self) -> Vec<&[f32]> {
        self.filled.iter().map(|one| &one.rgba[..]).collect()
    }

    fn change(&self, now: usize, before: usize) -> f64 {
        let lattice = self.order.first();
        let seen = |image: &ProjectorImage| sparse(&image.rgba, [image.width, image.height], lattice);
        let pairs = self.footage.pictures(now).iter().zip(self.footage.pictures(before));
        let (sum, count) = pairs.fold((0, 0), |(sum, count), (now, before)| {
            let (now, before) = (seen(now), seen(before));
            (sum + change_at(&now, &before), count + now.len())
        });
        sum as f64 * ERROR_UNIT / count.max(1) as f64
    }
}
