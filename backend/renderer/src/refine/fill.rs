//! Pixels that are not cast yet, from those around them that are and from the picture before; and what may be wrong with
//! them.
//!
//! From the coarsest lattice to the finest, first the middle of each square is made from its corners, then the middles of
//! its sides from what lies beside them. Each is made twice, as LFD figure 12 does with a single lattice: from its
//! neighbours N alone, and from what it was before and how they have changed since,
//!
//! ```text
//! in space = the mean of the opposite pair whose colours differ least
//! in time  = Q_before + mean of (N − N_before)
//! ```
//!
//! The variance of either, in linear RGB, is that of what it is made from, and what may be wrong with that already:
//!
//! ```text
//! in space: sum over neighbours of |N − mean of N|² / (n − 1)                              + mean of their variances
//! in time:  sum over neighbours of |(N − N_before) − mean of (N − N_before)|² / (n − 1)    + the same + Q's before
//! ```
//!
//! The pixel is the mean of both, each weighted by the inverse of its variance, and has the variance of that. So what stands
//! still keeps its detail however few rays are cast, what moves is filled from its surroundings, and nobody has to say where
//! one ends and the other begins. A pixel that was cast has no variance, and so a complete picture has none (the paper's ζ,
//! whose kernel also weighs the neighbours of pixels that it knows, never falls to 0 beside an edge).
//!
//! A pixel is made anew only where something that it is made from has changed since the picture was last filled, with fewer
//! units: the same to the bit as if all of it were made anew.

use super::around::{Around, CHANNELS, Pixel, Rim, pixel_at};
use super::{Grain, Order, UNITS, whole};

/// The largest distance between pixels that others are made from.
const COARSEST: i64 = 4;

type Way = [i64; 2];

// Of each pair of neighbours the one, in units of their distance; the other lies opposite.
const CORNERS: [Way; 2] = [[-1, -1], [1, -1]];
const SIDES: [Way; 2] = [[-1, 0], [0, -1]];
const ROWS: [Way; 1] = [[0, -1]];

/// A whole picture made of the part that is cast.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filled {
    /// Its colours, 4 numbers per pixel.
    pub rgba: Vec<f32>,
    /// The variance of each pixel; of a complete picture none.
    pub variances: Vec<f32>,
    /// ζ: the sum over its pixels of their standard deviations, in [`super::ERROR_UNIT`]s.
    pub spatial: u64,
    /// How it is cast and how many units of it are; none of a complete one, of which nothing is filled.
    so_far: Option<(Grain, u32)>,
}

impl Filled {
    /// Whether it goes on to a picture of this order with so many units.
    fn goes_on_to(&self, order: &Order, done: u32) -> bool {
        let is_like = |(grain, so_far): (Grain, u32)| grain == order.grain() && so_far <= done;
        self.so_far.is_some_and(is_like) && self.variances.len() == pixels_of(order)
    }
}

/// Fills a picture of which so many units are cast, at least one; with the picture before if there is one, and going on from
/// what was last made of this one with that same picture before.
///
/// # Panics
/// If the pictures are not of the order's size.
pub fn fill(cast: Vec<f32>, before: Option<&Filled>, last: Filled, order: &Order, done: u32) -> Filled {
    let pixels = pixels_of(order);
    assert_eq!(cast.len(), CHANNELS * pixels, "a picture of this raster");
    let is_fit = |before: &&Filled| before.rgba.len() == cast.len();
    assert!(before.as_ref().is_none_or(is_fit), "and the one before");
    if done >= UNITS {
        return Filled { rgba: cast, ..Filled::default() };
    }
    let is_new = !last.goes_on_to(order, done);
    let (picture, cast) = if is_new {
        (Filled { rgba: cast, variances: vec![0.0; pixels], spatial: 0, so_far: None }, None)
    } else {
        (last, Some(cast))
    };
    let [width, height] = order.size().map(i64::from);
    let has_changed = vec![false; pixels];
    let mut filling = Filling { order, before, done, width, height, is_new, picture, has_changed };
    cast.iter().for_each(|cast| filling.take_over(cast));
    filling.run()
}

fn pixels_of(order: &Order) -> usize {
    let [width, height] = order.size().map(|n| n as usize);
    width * height
}

struct Filling<'a> {
    order: &'a Order,
    before: Option<&'a Filled>,
    done: u32,
    width: i64,
    height: i64,
    /// Whether nothing of it was filled before.
    is_new: bool,
    /// What is made so far.
    picture: Filled,
    /// Of each pixel, whether it is another than when the picture was last filled.
    has_changed: Vec<bool>,
}

impl Filling<'_> {
    /// Takes the pixels that are cast over into what was last made.
    fn take_over(&mut self, cast: &[f32]) {
        for at in 0..self.has_changed.len() {
            if self.order.is_cast(at, self.done) {
                self.put(at, pixel_at(cast, at), 0.0);
            }
        }
    }

    /// Puts a pixel down, and notes whether it is another one.
    #[inline(always)]
    fn put(&mut self, at: usize, pixel: Pixel, variance: f32) {
        let Self { picture, has_changed, .. } = self;
        let (place, known) =
            (&mut picture.rgba[CHANNELS * at..CHANNELS * (at + 1)], &mut picture.variances[at]);
        let bits = |n: &f32| n.to_bits();
        has_changed[at] =
            !place.iter().map(bits).eq(pixel.iter().map(bits)) || bits(known) != bits(&variance);
        if has_changed[at] {
            picture.spatial -= whole(known.sqrt());
            picture.spatial += whole(variance.sqrt());
            place.copy_from_slice(&pixel);
            *known = variance;
        }
    }

    fn run(mut self) -> Filled {
        match self.order.grain() {
            Grain::Pixels => self.fill_squares(),
            Grain::Rows => self.fill_rows(),
        }
        self.picture.so_far = Some((self.order.grain(), self.done));
        self.picture
    }

    fn fill_squares(&mut self) {
        let mut scale = COARSEST;
        while scale > 0 {
            self.fill_lattice([scale; 2], [2 * scale; 2], scale, CORNERS);
            self.fill_lattice([scale, 0], [2 * scale; 2], scale, SIDES);
            self.fill_lattice([0, scale], [2 * scale; 2], scale, SIDES);
            scale /= 2;
        }
    }

    fn fill_rows(&mut self) {
        let begin = i64::from(self.order.first().first[1]);
        let mut scale = i64::from(UNITS) / 2;
        while scale > 0 {
            self.fill_lattice([0, (begin + scale) % (2 * scale)], [1, 2 * scale], scale, ROWS);
            scale /= 2;
        }
    }

    /// Makes those pixels of a lattice that are not cast from neighbours at a distance.
    fn fill_lattice<const PAIRS: usize>(&mut self, first: Way, step: Way, distance: i64, ways: [Way; PAIRS]) {
        // From a pixel to the first of each pair; the second lies as far the other way.
        let ways = ways.map(|way| way.map(|along| distance * along));
        let offsets = ways.map(|[dx, dy]| dy * self.width + dx);
        let reach = [0, 1].map(|axis| ways.iter().map(|way| way[axis].abs()).max().unwrap_or(0));
        let inside = |at: i64, size: i64, reach: i64| at >= reach && at + reach < size;
        for y in (first[1]..self.height).step_by(step[1] as usize) {
            let is_row_inside = inside(y, self.height, reach[1]);
            for x in (first[0]..self.width).step_by(step[0] as usize) {
                let at = (y * self.width + x) as usize;
                if self.order.is_cast(at, self.done) {
                    continue;
                }
                if is_row_inside && inside(x, self.width, reach[0]) {
                    let pairs =
                        offsets.map(|offset| [at as i64 + offset, at as i64 - offset].map(|at| at as usize));
                    self.make(at, Around::new(pairs.as_flattened(), &pairs));
                } else {
                    let mut rim = Rim::default();
                    for [dx, dy] in ways {
                        rim.add([self.place(x + dx, y + dy), self.place(x - dx, y - dy)]);
                    }
                    self.make(at, rim.around());
                }
            }
        }
    }

    /// Makes a pixel from its neighbours, if they are not as they were.
    #[inline(always)]
    fn make(&mut self, at: usize, around: Around) {
        if self.is_new || around.places.iter().any(|&place| self.has_changed[place]) {
            let (pixel, variance) = self.estimate(at, around);
            self.put(at, pixel, variance);
        }
    }

    /// The colour of a pixel from its neighbours, and its variance.
    #[inline(always)]
    fn estimate(&self, at: usize, around: Around) -> (Pixel, f32) {
        if let Some(known) = self.as_before(at, around) {
            return (known, 0.0);
        }
        let now = |at: usize| pixel_at(&self.picture.rgba, at);
        let neighbours = around.places.len().max(1) as f32;
        let wrong = around.places.iter().map(|&at| self.picture.variances[at]).sum::<f32>() / neighbours;
        let in_space = around.in_space(&self.picture.rgba);
        let space = around.variance(now) + wrong;
        let Some(before) = self.before else { return (in_space, space) };
        let change = |at: usize| {
            let (now, was) = (now(at), pixel_at(&before.rgba, at));
            std::array::from_fn(|i| now[i] - was[i])
        };
        let (was, typical) = (pixel_at(&before.rgba, at), around.mean(change));
        // Light is not negative, and opacity at most 1.
        let in_time: Pixel = std::array::from_fn(|i| (was[i] + typical[i]).clamp(0.0, was[i].max(1.0)));
        let time = around.variance(change) + wrong + before.variances.get(at).copied().unwrap_or(0.0);
        // Of two that nothing speaks against, the one that knows the pixel itself.
        let share = if time > 0.0 { time / (time + space) } else { 0.0 };
        (std::array::from_fn(|i| in_time[i] + share * (in_space[i] - in_time[i])), share * space)
    }

    /// The pixel of the picture before, if that and all around are known and nothing around has changed: most of a picture is
    /// empty, or stands still.
    #[inline(always)]
    fn as_before(&self, at: usize, around: Around) -> Option<Pixel> {
        let before = self.before?;
        let is_known = before.variances.get(at).is_none_or(|&variance| variance == 0.0);
        let stays = |&at: &usize| {
            self.picture.variances[at] == 0.0
                && pixel_at(&self.picture.rgba, at) == pixel_at(&before.rgba, at)
        };
        (is_known && around.places.iter().all(stays)).then(|| pixel_at(&before.rgba, at))
    }

    /// The place of a pixel; None outside the raster.
    fn place(&self, x: i64, y: i64) -> Option<usize> {
        let is_inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        is_inside.then(|| (y * self.width + x) as usize)
    }
}

#[cfg(test)]
#[path = "fill_tests.rs"]
mod tests;
