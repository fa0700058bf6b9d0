//! The neighbours that a pixel is made from.

/// Channels of a pixel: red, green, blue, opacity.
pub(super) const CHANNELS: usize = 4;

pub(super) type Pixel = [f32; CHANNELS];

#[inline(always)]
pub(super) fn pixel_at(picture: &[f32], at: usize) -> Pixel {
    *picture[CHANNELS * at..].first_chunk().expect("a pixel of the picture")
}

/// At most four, in opposite pairs where both are inside the raster.
#[derive(Clone, Copy)]
pub(super) struct Around<'a> {
    pub(super) places: &'a [usize],
    pairs: &'a [[usize; 2]],
}

impl<'a> Around<'a> {
    #[inline(always)]
    pub(super) fn new(places: &'a [usize], pairs: &'a [[usize; 2]]) -> Self {
        Self { places, pairs }
    }

    /// The mean of what is said of each; 0 of none.
    #[inline(always)]
    pub(super) fn mean(&self, of: impl Fn(usize) -> Pixel) -> Pixel {
        let mut sum = [0.0; CHANNELS];
        for &place in self.places {
            let one = of(place);
            sum = std::array::from_fn(|i| sum[i] + one[i]);
        }
        sum.map(|sum| sum / self.places.len().max(1) as f32)
    }

    /// The variance of the colours that are said of each; a single one does not differ from itself.
    #[inline(always)]
    pub(super) fn variance(&self, of: impl Fn(usize) -> Pixel) -> f32 {
        let mean = self.mean(&of);
        let square = |&place: &usize| {
            let one = of(place);
            (0..3).map(|i| (one[i] - mean[i]) * (one[i] - mean[i])).sum::<f32>()
        };
        self.places.iter().map(square).sum::<f32>() / (self.places.len() as f32 - 1.0).max(1.0)
    }

    /// The mean of the opposite pair whose colours differ least. At the rim there may be no whole pair.
    #[inline(always)]
    pub(super) fn in_space(&self, rgba: &[f32]) -> Pixel {
        let mut best: Option<(f32, Pixel)> = None;
        for &[a, b] in self.pairs {
            let [a, b] = [a, b].map(|at| pixel_at(rgba, at));
            let apart = a.iter().zip(b).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
            if best.is_none_or(|(least, _)| apart < least) {
                best = Some((apart, std::array::from_fn(|i| 0.5 * (a[i] + b[i]))));
            }
        }
        best.map_or_else(|| self.mean(|at| pixel_at(rgba, at)), |(_, mean)| mean)
    }
}

/// Those of a pixel at the rim of a raster.
#[derive(Default)]
pub(super) struct Rim {
    places: [usize; 4],
    count: usize,
    pairs: [[usize; 2]; 2],
    pair_count: usize,
}

impl Rim {
    pub(super) fn add(&mut self, pair: [Option<usize>; 2]) {
        if let [Some(a), Some(b)] = pair {
            self.pairs[self.pair_count] = [a, b];
            self.pair_count += 1;
        }
        for place in pair.into_iter().flatten() {
            self.places[self.count] = place;
            self.count += 1;
        }
    }

    pub(super) fn around(&self) -> Around<'_> {
        Around::new(&self.places[..self.count], &self.pairs[..self.pair_count])
    }
}
