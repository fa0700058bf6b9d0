//! Pixels that were not cast, from those that were and from what was shown before (after LFD section 5, figure 12).
//!
//! Of one cast class of pixels, first their diagonal neighbours are made from the four cast ones around each, then all
//! others from the four beside them. A missing pixel Q, with neighbours N in opposite pairs, becomes
//!
//! ```text
//! spatial  = the mean of the opposite pair whose colours differ least
//! temporal = Q_before + mean of (N − N_before)
//! disorder = the largest distance of a neighbour's change N − N_before from their mean
//! Q'       = mix(temporal, spatial, smoothstep(disorder, low, high))
//! ```
//!
//! What stands still keeps its detail, also while light or opacity change all over it, and what moves blurs rather than
//! tears. The paper keeps Q_before where no neighbour changes by much, and takes `spatial` elsewhere: then whatever
//! changes a little everywhere loses its detail. Pixels that have been cast since rays last saw something else are shown
//! as they were cast, whatever the filter says: so a still view comes to the full picture.

use super::Classes;
use layout::present::MOST_PAIRS;

/// Size of a picture, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Along x.
    pub width: usize,
    /// Along y.
    pub height: usize,
}

impl Raster {
    /// Of pixels along x and y.
    pub fn of(size: [u32; 2]) -> Self {
        let [width, height] = size.map(|along| along as usize);
        Self { width, height }
    }
}

/// How differently a pixel's neighbours must have changed, in linear colour, for it to be made from them alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Up to here it changes as they do.
    pub low: f32,
    /// From here on it is what they are.
    pub high: f32,
}

impl Default for Thresholds {
    /// The best of a sweep over moving scenes: the study `reconstruction`.
    fn default() -> Self {
        Self { low: 16.0 / 255.0, high: 64.0 / 255.0 }
    }
}

type Pixel = [f32; 4];
/// The way to a neighbour, pixels.
type Step = [i32; 2];

// Of each pair of neighbours the one; the other lies opposite.
const BESIDE: &[Step] = &[[-1, 0], [0, -1]];
const DIAGONAL: &[Step] = &[[-1, -1], [1, -1]];
/// Where whole rows are known: those above and below.
const ACROSS_ROWS: &[Step] = &[[0, -1], [-1, -1], [1, -1]];
/// Where whole columns are.
const ACROSS_COLUMNS: &[Step] = &[[-1, 0], [-1, -1], [1, -1]];

/// One pass over a picture: some missing pixels are made of neighbours that are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// The pixels to make.
    pub missing: Classes,
    /// Of each pair of their neighbours the one.
    pub pairs: &'static [Step],
}

/// The passes after which no pixel is missing, where those of some classes are known.
pub fn passes(known: Classes) -> impl Iterator<Item = Pass> {
    let diagonal = known.diagonal_of_one();
    let known = diagonal.map_or(known, |diagonal| known.with(diagonal));
    let pairs = match known {
        known if known.are_rows() => ACROSS_ROWS,
        known if known.are_columns() => ACROSS_COLUMNS,
        _ => BESIDE,
    };
    let first = diagonal.map(|missing| Pass { missing, pairs: DIAGONAL });
    let last = (known != Classes::ALL).then(|| Pass { missing: Classes::ALL.without(known), pairs });
    first.into_iter().chain(last)
}

/// One pass over a picture: the neighbours of all pixels to make are known where they are in the raster.
#[derive(Clone, Copy)]
pub(super) struct Filter<'a> {
    pub(super) picture: &'a [f32],
    pub(super) raster: Raster,
    pub(super) pass: Pass,
    pub(super) thresholds: Thresholds,
}

/// Some rows of what was shown before.
#[derive(Clone, Copy)]
pub(super) struct Before<'a> {
    pub(super) numbers: &'a [f32],
    /// Of a whole picture, the index of the first of these.
    pub(super) first: usize,
}

impl Before<'_> {
    fn pixel(&self, at: usize) -> Pixel {
        pixel_at(self.numbers, at - self.first)
    }
}

/// The neighbours of a pixel: the indices of their first numbers, pair by pair, those outside the raster left out.
#[derive(Default)]
struct Around {
    places: [usize; 2 * MOST_PAIRS],
    count: usize,
    /// Where whole pairs begin among these.
    pairs: [usize; MOST_PAIRS],
    pair_count: usize,
}

impl Around {
    fn places(&self) -> &[usize] {
        &self.places[..self.count]
    }

    fn add(&mut self, pair: [Option<usize>; 2]) {
        if pair[0].is_some() && pair[1].is_some() {
            self.pairs[self.pair_count] = self.count;
            self.pair_count += 1;
        }
        for place in pair.into_iter().flatten() {
            self.places[self.count] = place;
            self.count += 1;
        }
    }
}

impl Filter<'_> {
    /// The neighbours of a pixel.
    fn around(&self, x: usize, y: usize) -> Around {
        let Raster { width, height } = self.raster;
        let mut around = Around::default();
        let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
        for &[dx, dy] in self.pass.pairs {
            around.add([[dx, dy], [-dx, -dy]].map(|[dx, dy]| {
                let (x, y) = (x.wrapping_add_signed(dx as isize), y.wrapping_add_signed(dy as isize));
                (is_inside || (x < width && y < height)).then_some(4 * (y * width + x))
            }));
        }
        around
    }

    /// A missing pixel, any of whose neighbours have moved or not.
    pub(super) fn pixel(&self, x: usize, y: usize, before: Option<Before>, moves: bool) -> Pixel {
        let at = 4 * (y * self.raster.width + x);
        match before {
            None => self.in_space(at, &self.around(x, y)),
            Some(before) if moves => self.in_time(before, at, &self.around(x, y)),
            // Most of a picture is empty, or stands still.
            Some(before) => before.pixel(at),
        }
    }

    /// The mean of the opposite pair whose colours differ least. At the rim there may be no whole pair; in a raster of a
    /// single pixel, no neighbour at all.
    fn in_space(&self, at: usize, around: &Around) -> Pixel {
        let mut best: Option<(f32, Pixel)> = None;
        for &pair in &around.pairs[..around.pair_count] {
            let [a, b] = [0, 1].map(|i| pixel_at(self.picture, around.places[pair + i]));
            let apart = difference(a, b);
            if best.is_none_or(|(least, _)| apart < least) {
                best = Some((apart, std::array::from_fn(|i| 0.5 * (a[i] + b[i]))));
            }
        }
        match best {
            Some((_, mean)) => mean,
            None if around.count > 0 => mean(around.places(), |at| pixel_at(self.picture, at)),
            None => pixel_at(self.picture, at),
        }
    }

    /// The colour of a pixel, made from those around it in space and in time.
    fn in_time(&self, before: Before, at: usize, around: &Around) -> Pixel {
        let change = |at| {
            let (now, was) = (pixel_at(self.picture, at), before.pixel(at));
            std::array::from_fn(|i| now[i] - was[i])
        };
        let typical = mean(around.places(), change);
        let disorder =
            around.places().iter().fold(0.0_f32, |most, &at| most.max(difference(change(at), typical)));
        let was = before.pixel(at);
        let temporal = |i: usize| (was[i] + typical[i]).clamp(0.0, was[i].max(1.0));
        match self.thresholds.share(disorder) {
            0.0 => std::array::from_fn(temporal),
            // To the bit, as the sum below is not.
            1.0 => self.in_space(at, around),
            share => {
                let spatial = self.in_space(at, around);
                std::array::from_fn(|i| temporal(i) + share * (spatial[i] - temporal(i)))
            }
        }
    }
}

/// The mean of what is said of some places; 0 of none.
fn mean(places: &[usize], of: impl Fn(usize) -> Pixel) -> Pixel {
    let mut sum = [0.0; 4];
    for &place in places {
        let one = of(place);
        sum = std::array::from_fn(|i| sum[i] + one[i]);
    }
    sum.map(|sum| sum / places.len().max(1) as f32)
}

impl Thresholds {
    /// smoothstep(change, low, high).
    fn share(&self, change: f32) -> f32 {
        let s = ((change - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    }
}

fn pixel_at(picture: &[f32], at: usize) -> Pixel {
    [picture[at], picture[at + 1], picture[at + 2], picture[at + 3]]
}

/// The largest difference of any of a pixel's numbers.
fn difference(a: Pixel, b: Pixel) -> f32 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}
