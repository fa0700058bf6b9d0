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

use super::{Grain, Order, UNITS, whole};

/// Channels of a pixel: red, green, blue, opacity.
const CHANNELS: usize = 4;
/// The largest distance between pixels that others are made from.
const COARSEST: i64 = 4;

type Pixel = [f32; CHANNELS];
type Way = [i64; 2];

// Of each pair of neighbours the one, in units of their distance; the other lies opposite.
const CORNERS: &[Way] = &[[-1, -1], [1, -1]];
const SIDES: &[Way] = &[[-1, 0], [0, -1]];
const ROWS: &[Way] = &[[0, -1]];

/// A whole picture made of the part that is cast.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filled {
    /// Its colours, 4 numbers per pixel.
    pub rgba: Vec<f32>,
    /// The variance of each pixel; of a complete picture none.
    pub variances: Vec<f32>,
    /// ζ: the sum over its pixels of their standard deviations, in [`super::ERROR_UNIT`]s.
    pub spatial: u64,
}

/// Fills a picture of which so many units are cast, at least one; with the picture before if there is one.
///
/// # Panics
/// If the pictures are not of the order's size.
pub fn fill(cast: Vec<f32>, before: Option<&Filled>, order: &Order, done: u32) -> Filled {
    let [width, height] = order.size().map(i64::from);
    assert_eq!(cast.len(), CHANNELS * (width * height) as usize, "a picture of this raster");
    let is_fit = |before: &&Filled| before.rgba.len() == cast.len();
    assert!(before.as_ref().is_none_or(is_fit), "and the one before");
    let picture = Filled { rgba: cast, ..Filled::default() };
    if done >= UNITS {
        return picture;
    }
    let mut filling = Filling { order, before, done, width, height, picture };
    filling.picture.variances = vec![0.0; (width * height) as usize];
    match order.grain() {
        Grain::Pixels => filling.fill_squares(),
        Grain::Rows => filling.fill_rows(),
    }
    filling.picture
}

struct Filling<'a> {
    order: &'a Order,
    before: Option<&'a Filled>,
    done: u32,
    width: i64,
    height: i64,
    /// What is made so far.
    picture: Filled,
}

impl Filling<'_> {
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
    fn fill_lattice(&mut self, first: Way, step: Way, distance: i64, ways: &[Way]) {
        for y in (first[1]..self.height).step_by(step[1] as usize) {
            for x in (first[0]..self.width).step_by(step[0] as usize) {
                let at = (y * self.width + x) as usize;
                if self.order.is_cast(at, self.done) {
                    continue;
                }
                let (pixel, variance) = self.estimate([x, y], distance, ways);
                self.picture.rgba[CHANNELS * at..CHANNELS * (at + 1)].copy_from_slice(&pixel);
                self.picture.variances[at] = variance;
                self.picture.spatial += whole(variance.sqrt());
            }
        }
    }

    /// The colour of a pixel from its neighbours, and its variance.
    fn estimate(&self, [x, y]: Way, distance: i64, ways: &[Way]) -> (Pixel, f32) {
        let mut around = Around::default();
        for [dx, dy] in ways.iter().map(|way| way.map(|along| distance * along)) {
            around.add([self.place(x + dx, y + dy), self.place(x - dx, y - dy)]);
        }
        let at = (y * self.width + x) as usize;
        if let Some(known) = self.as_before(at, &around) {
            return (known, 0.0);
        }
        let now = |at: usize| pixel_at(&self.picture.rgba, at);
        let neighbours = around.count.max(1) as f32;
        let wrong = around.places().map(|at| self.picture.variances[at]).sum::<f32>() / neighbours;
        let in_space = self.in_space(&around);
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
    fn as_before(&self, at: usize, around: &Around) -> Option<Pixel> {
        let before = self.before?;
        let is_known = before.variances.get(at).is_none_or(|&variance| variance == 0.0);
        let stays = |at: usize| {
            let place = CHANNELS * at..CHANNELS * (at + 1);
            self.picture.variances[at] == 0.0 && self.picture.rgba[place.clone()] == before.rgba[place]
        };
        (is_known && around.places().all(stays)).then(|| pixel_at(&before.rgba, at))
    }

    /// The mean of the opposite pair whose colours differ least. At the rim there may be no whole pair.
    fn in_space(&self, around: &Around) -> Pixel {
        let mut best: Option<(f32, Pixel)> = None;
        for &[a, b] in &around.pairs[..around.pair_count] {
            let [a, b] = [a, b].map(|at| pixel_at(&self.picture.rgba, at));
            let apart = a.iter().zip(b).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
            if best.is_none_or(|(least, _)| apart < least) {
                best = Some((apart, std::array::from_fn(|i| 0.5 * (a[i] + b[i]))));
            }
        }
        best.map_or_else(|| around.mean(|at| pixel_at(&self.picture.rgba, at)), |(_, mean)| mean)
    }

    /// The place of a pixel; None outside the raster.
    fn place(&self, x: i64, y: i64) -> Option<usize> {
        let is_inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        is_inside.then(|| (y * self.width + x) as usize)
    }
}

fn pixel_at(picture: &[f32], at: usize) -> Pixel {
    std::array::from_fn(|i| picture[CHANNELS * at + i])
}

/// The neighbours that a pixel is made from: at most four, in opposite pairs where both are inside the raster.
#[derive(Default)]
struct Around {
    places: [usize; 4],
    count: usize,
    pairs: [[usize; 2]; 2],
    pair_count: usize,
}

impl Around {
    fn add(&mut self, pair: [Option<usize>; 2]) {
        if let [Some(a), Some(b)] = pair {
            self.pairs[self.pair_count] = [a, b];
            self.pair_count += 1;
        }
        for place in pair.into_iter().flatten() {
            self.places[self.count] = place;
            self.count += 1;
        }
    }

    fn places(&self) -> impl Iterator<Item = usize> + '_ {
        self.places[..self.count].iter().copied()
    }

    /// The mean of what is said of each; 0 of none.
    fn mean(&self, of: impl Fn(usize) -> Pixel) -> Pixel {
        let mut sum = [0.0; CHANNELS];
        for place in self.places() {
            let one = of(place);
            sum = std::array::from_fn(|i| sum[i] + one[i]);
        }
        sum.map(|sum| sum / self.count.max(1) as f32)
    }

    /// The variance of the colours that are said of each; a single one does not differ from itself.
    fn variance(&self, of: impl Fn(usize) -> Pixel) -> f32 {
        let mean = self.mean(&of);
        let square = |place| {
            let one = of(place);
            (0..3).map(|i| (one[i] - mean[i]) * (one[i] - mean[i])).sum::<f32>()
        };
        self.places().map(square).sum::<f32>() / (self.count as f32 - 1.0).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::ERROR_UNIT;

    const SIZES: [[u32; 2]; 5] = [[1, 1], [7, 9], [64, 48], [131, 97], [3, 200]];

    /// A picture of some function of x and y, in every channel.
    fn picture([width, height]: [u32; 2], colour: impl Fn(f32, f32) -> f32) -> Vec<f32> {
        (0..width * height).flat_map(|i| [colour((i % width) as f32, (i / width) as f32); 4]).collect()
    }

    /// The picture with what is not cast yet spoiled: nothing may look at it.
    fn unknown(mut picture: Vec<f32>, order: &Order, done: u32) -> Vec<f32> {
        for (at, pixel) in picture.chunks_exact_mut(4).enumerate() {
            if !order.is_cast(at, done) {
                pixel.fill(f32::NAN);
            }
        }
        picture
    }

    #[test]
    fn a_complete_picture_is_what_was_cast_and_has_no_error() {
        for grain in [Grain::Pixels, Grain::Rows] {
            for size in SIZES {
                let (order, cast) = (Order::new(grain, size), picture(size, |x, y| (x * 0.7 + y * y).sin()));
                assert_eq!(
                    fill(cast.clone(), None, &order, UNITS),
                    Filled { rgba: cast, ..Filled::default() }
                );
            }
        }
    }

    #[test]
    fn one_colour_is_filled_from_its_first_unit_on_with_no_error() {
        for grain in [Grain::Pixels, Grain::Rows] {
            for size in SIZES {
                let (order, flat) = (Order::new(grain, size), picture(size, |_, _| 0.25));
                for done in [1, 2, 3, 4, 5, 15, 16, 17, 33, 63] {
                    let filled = fill(unknown(flat.clone(), &order, done), None, &order, done);
                    assert_eq!((&filled.rgba, filled.spatial), (&flat, 0), "{grain:?} {size:?} {done}");
                }
            }
        }
    }

    #[test]
    fn what_is_cast_stays_and_nothing_looks_at_what_is_not() {
        for grain in [Grain::Pixels, Grain::Rows] {
            let size = [131, 97];
            let (order, full) =
                (Order::new(grain, size), picture(size, |x, y| (0.3 * x).sin() * (0.2 * y).cos()));
            for done in 1..UNITS {
                let filled = fill(unknown(full.clone(), &order, done), None, &order, done);
                for (at, (filled, cast)) in filled.rgba.chunks_exact(4).zip(full.chunks_exact(4)).enumerate()
                {
                    assert!(filled.iter().all(|n| n.is_finite()));
                    assert!(!order.is_cast(at, done) || filled == cast);
                }
            }
        }
    }

    #[test]
    fn more_units_leave_less_error_and_the_estimate_follows_it() {
        let size = [160, 120];
        let (order, full) = (
            Order::new(Grain::Pixels, size),
            picture(size, |x, y| 0.5 + 0.5 * (0.1 * x + 0.004 * y * y).sin()),
        );
        let mut last = f64::INFINITY;
        for done in [1, 4, 16, 32, 48] {
            let filled = fill(unknown(full.clone(), &order, done), None, &order, done);
            let pixels = (size[0] * size[1]) as f64;
            let true_error: f64 =
                filled.rgba.iter().zip(&full).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>()
                    / (4.0 * pixels);
            let estimate = filled.spatial as f64 * ERROR_UNIT / pixels;
            assert!(true_error < last && estimate > 0.5 * true_error, "{done}: {true_error} {estimate}");
            last = true_error;
        }
    }

    #[test]
    fn an_edge_beside_a_missing_pixel_is_its_error() {
        // Nine columns: 0 and 8 are cast first, one dark and one bright; between them all is made.
        let size = [9, 1];
        let order = Order::new(Grain::Pixels, size);
        let full = picture(size, |x, _| if x < 4.0 { 0.0 } else { 1.0 });
        let filled = fill(unknown(full, &order, 1), None, &order, 1);
        assert_eq!(filled.rgba[16], 0.5, "the middle of the two");
        // The variance of 0 and 1 is 1/2 in each of three channels.
        let middle = (1.5_f64).sqrt();
        assert!(filled.spatial as f64 * ERROR_UNIT > middle);
    }

    #[test]
    fn what_stands_still_keeps_its_detail_and_has_no_error() {
        for grain in [Grain::Pixels, Grain::Rows] {
            let size = [131, 97];
            let (order, full) =
                (Order::new(grain, size), picture(size, |x, y| (0.9 * x).sin() * (1.2 * y).cos() + 1.0));
            let before = fill(full.clone(), None, &order, UNITS);
            for done in [1, 7, 33] {
                let filled = fill(unknown(full.clone(), &order, done), Some(&before), &order, done);
                assert_eq!((&filled.rgba, filled.spatial), (&full, 0), "{grain:?} {done}");
            }
        }
    }

    #[test]
    fn what_becomes_brighter_everywhere_keeps_its_detail() {
        let size = [64, 48];
        let order = Order::new(Grain::Pixels, size);
        let at = |light: f32| picture(size, |x, y| 0.5 + light + 0.2 * (2.0 * x).sin() * (2.5 * y).cos());
        let (dark, bright) = (fill(at(0.0), None, &order, UNITS), at(0.1));
        let error = |before| {
            let filled = fill(unknown(bright.clone(), &order, 2), before, &order, 2);
            filled.rgba.iter().zip(&bright).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
        };
        assert!(error(Some(&dark)) < 1e-5 && error(None) > 0.1, "{} {}", error(Some(&dark)), error(None));
    }

    #[test]
    fn what_has_gone_leaves_nothing_behind() {
        // A bright square that is elsewhere now.
        let size = [64, 64];
        let order = Order::new(Grain::Pixels, size);
        let square = |left: f32| {
            picture(size, |x, y| {
                if (left..left + 20.0).contains(&x) && (16.0..40.0).contains(&y) { 1.0 } else { 0.0 }
            })
        };
        let before = fill(square(4.0), None, &order, UNITS);
        let now = square(36.0);
        for done in [4, 16, 32] {
            let filled = fill(unknown(now.clone(), &order, done), Some(&before), &order, done);
            let alone = fill(unknown(now.clone(), &order, done), None, &order, done);
            // Where it was: columns 4 to 23; it is at columns 36 to 55 now.
            let left = |rgba: &[f32]| -> f32 {
                rgba.chunks_exact(4)
                    .enumerate()
                    .filter(|(at, _)| at % 64 < 28)
                    .map(|(_, pixel)| pixel[0])
                    .sum()
            };
            let (left, left_alone) = (left(&filled.rgba), left(&alone.rgba));
            assert!(
                left <= left_alone + 0.02 * 480.0,
                "{done}: {left} of 480 are left, {left_alone} without the past"
            );
        }
    }
}
