//! Ordered dither: a threshold for each pixel, the same in every frame.

use layout::present::DITHER_BITS;

const BITS: usize = DITHER_BITS as usize;
const LEVELS: f32 = (1 << (2 * BITS)) as f32;

/// The threshold of a pixel, between 0 and 1: Bayer's matrix (1973) of 8 × 8, whose tiles differ by less than its steps in
/// such a way that 4 × 4 of them have each threshold of 1024 once. So the mean of a level area is right to 1/2048 of a step,
/// where 8 × 8 thresholds alone would leave up to 1/128.
pub(super) fn threshold([x, y]: [usize; 2]) -> f32 {
    let quarter = |bit: usize| {
        let (x, y) = (x >> bit & 1, y >> bit & 1);
        2 * (x ^ y) + y
    };
    // Neighbours differ in the lowest bits, which count most.
    let rank = (0..BITS).fold(0, |rank, bit| 4 * rank + quarter(bit));
    (rank as f32 + 0.5) / LEVELS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_begins_as_bayer_s_matrix_of_four_and_has_every_threshold_once() {
        let rank = |x, y, levels: f32| (threshold([x, y]) * levels) as usize;
        let four: Vec<usize> = (0..4).flat_map(|y| (0..4).map(move |x| rank(x, y, 16.0))).collect();
        assert_eq!(four, [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5]);
        let mut all: Vec<usize> = (0..32).flat_map(|y| (0..32).map(move |x| rank(x, y, 1024.0))).collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..1024));
        assert_eq!(threshold([3, 40]), threshold([35, 8]));
    }
}
