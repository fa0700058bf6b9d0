//! A histogram, and what its shape tells.

/// Parts of the range.
const BINS: usize = 128;
/// The part of the voxels on either side that the range leaves out: a few hot voxels must not hide all others.
const RARE: f64 = 1e-3;

/// How many values lie in each of equal parts of a range.
#[derive(Clone, Debug)]
pub(super) struct Histogram {
    pub low: f64,
    pub high: f64,
    /// Of all values in the range.
    shares: Vec<f64>,
    /// The commonest of the values in the fullest part.
    background: f64,
}

impl Histogram {
    /// Of values that rise; there is at least one.
    pub fn new(sorted: &[f32]) -> Self {
        let last = sorted.len() - 1;
        let rare = (RARE * last as f64) as usize;
        let [mut low, mut high] = [sorted[rare], sorted[last - rare]].map(f64::from);
        if low == high {
            (low, high) = (f64::from(sorted[0]), f64::from(sorted[last]));
        }
        let width = (high - low) / BINS as f64;
        let place = |bin: usize| match bin {
            0 => sorted.partition_point(|&v| f64::from(v) < low),
            BINS => sorted.partition_point(|&v| f64::from(v) <= high),
            bin => sorted.partition_point(|&v| f64::from(v) < low + bin as f64 * width),
        };
        let places: Vec<usize> = (0..=BINS).map(place).collect();
        let count = |bin: usize| places[bin + 1].saturating_sub(places[bin]);
        let total = (0..BINS).map(count).sum::<usize>().max(1) as f64;
        let fullest = (0..BINS).max_by_key(|&bin| count(bin)).unwrap_or(0);
        Self {
            low,
            high,
            shares: (0..BINS).map(|bin| count(bin) as f64 / total).collect(),
            background: commonest(&sorted[places[fullest]..places[fullest + 1].max(places[fullest] + 1)]),
        }
    }

    pub fn width(&self) -> f64 {
        self.high - self.low
    }

    /// The commonest value.
    pub fn background(&self) -> f64 {
        self.background
    }

    /// Where in the range a value lies, from 0 to 1.
    pub fn place(&self, value: f64) -> f64 {
        if self.width() > 0.0 { (value - self.low) / self.width() } else { 0.0 }
    }

    /// The value that divides the range into two classes that differ most (Otsu 1979).
    pub fn threshold(&self) -> f64 {
        let mean = self.shares.iter().enumerate().map(|(bin, share)| bin as f64 * share).sum::<f64>();
        let (mut below, mut sum, mut best) = (0.0, 0.0, (0.0, 0));
        for (bin, share) in self.shares.iter().enumerate().take(BINS - 1) {
            below += share;
            sum += bin as f64 * share;
            let between = (mean * below - sum).powi(2) / (below * (1.0 - below)).max(f64::MIN_POSITIVE);
            if between > best.0 {
                best = (between, bin + 1);
            }
        }
        self.low + best.1 as f64 / BINS as f64 * self.width()
    }

    /// Whether there is a second peak above the background, with a valley between them.
    pub fn has_second_peak(&self) -> bool {
        let smooth: Vec<f64> = (0..BINS).map(|bin| self.smooth(bin)).collect();
        let start = (self.place(self.background) * BINS as f64) as usize;
        let mut valley = f64::INFINITY;
        for (bin, &share) in smooth.iter().enumerate().skip(start + 1) {
            valley = valley.min(share);
            if bin > start + BINS / 10 && share > 1.25 * valley && share > 0.2 / BINS as f64 {
                return true;
            }
        }
        false
    }

    /// The mean of a part and its neighbours.
    fn smooth(&self, bin: usize) -> f64 {
        let around = &self.shares[bin.saturating_sub(3)..(bin + 4).min(BINS)];
        around.iter().sum::<f64>() / around.len() as f64
    }
}

/// The longest run of equal values; the middle where all differ.
fn commonest(sorted: &[f32]) -> f64 {
    let longest = sorted.chunk_by(|a, b| a == b).max_by_key(|run| run.len());
    let middle = sorted[sorted.len() / 2];
    f64::from(longest.filter(|run| 20 * run.len() > sorted.len()).map_or(middle, |run| run[0]))
}
