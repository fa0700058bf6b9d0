//! Times, counted in boxes whose limits grow by a fixed share: so much room for a minute as for a month.

use serde::Serialize;
use std::time::Duration;

/// The upper limit of the first box, milliseconds.
const FIRST_MS: f64 = 1e-3;
/// Each box ends so many times as late as the one before.
const GROWTH: f64 = 1.02;
/// Boxes: up to 20 minutes.
const BOXES: usize = 1050;

/// Counts of times.
#[derive(Clone, Debug)]
pub struct Histogram {
    boxes: Vec<u64>,
    most_ms: f64,
}

/// What half, 99 of a hundred and all of them do not exceed, milliseconds: to two percent, the largest exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Quantiles {
    /// How many there are.
    pub count: u64,
    /// The median.
    pub p50: f64,
    /// What 99 % do not exceed.
    pub p99: f64,
    /// The largest.
    pub max: f64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { boxes: vec![0; BOXES], most_ms: 0.0 }
    }
}

fn upper_limit_ms(place: usize) -> f64 {
    FIRST_MS * GROWTH.powi(place as i32)
}

impl Histogram {
    /// Counts a time.
    pub fn add(&mut self, time: Duration) {
        let ms = time.as_secs_f64() * 1e3;
        let place = ((ms / FIRST_MS).ln() / GROWTH.ln()).ceil().clamp(0.0, (BOXES - 1) as f64);
        self.boxes[place as usize] += 1;
        self.most_ms = self.most_ms.max(ms);
    }

    /// Its quantiles.
    pub fn quantiles(&self) -> Quantiles {
        let count: u64 = self.boxes.iter().sum();
        let quantile = |share: f64| {
            let rank = (share * count as f64).ceil() as u64;
            let mut seen = 0;
            let place = self.boxes.iter().position(|boxed| {
                seen += boxed;
                seen >= rank.max(1)
            });
            place.map_or(0.0, |place| upper_limit_ms(place).min(self.most_ms))
        };
        Quantiles { count, p50: quantile(0.5), p99: quantile(0.99), max: self.most_ms }
    }

    /// Pairs of a time, milliseconds, and the share of all times that exceed it; where anything was counted.
    pub fn beyond(&self) -> Vec<(f64, f64)> {
        let count: u64 = self.boxes.iter().sum();
        let mut left = count;
        let mut points = Vec::new();
        for (place, &boxed) in self.boxes.iter().enumerate().filter(|(_, boxed)| **boxed > 0) {
            points.push((upper_limit_ms(place), left as f64 / count as f64));
            left -= boxed;
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_sorted_times_to_two_percent() {
        let mut histogram = Histogram::default();
        let mut times: Vec<f64> = (1..=5000_u32).map(|i| 0.05 * f64::from(i * 37 % 5000)).collect();
        times.iter().for_each(|ms| histogram.add(Duration::from_secs_f64(ms / 1e3)));
        times.sort_by(f64::total_cmp);
        let Quantiles { count, p50, p99, max } = histogram.quantiles();
        assert_eq!(count, 5000);
        for (found, expected) in [(p50, times[2499]), (p99, times[4949])] {
            assert!((expected..=1.021 * expected).contains(&found), "{found} for {expected}");
        }
        assert!((max - times[4999]).abs() < 1e-5);
        assert_eq!(Histogram::default().quantiles(), Quantiles::default());
    }

    #[test]
    fn shares_beyond_fall_from_one() {
        let mut histogram = Histogram::default();
        [1, 1, 2, 1000].iter().for_each(|&ms| histogram.add(Duration::from_millis(ms)));
        let shares: Vec<f64> = histogram.beyond().iter().map(|point| point.1).collect();
        assert_eq!(shares, [1.0, 0.5, 0.25]);
        histogram.add(Duration::from_secs(1 << 30));
        assert_eq!(histogram.quantiles().count, 5);
    }
}
