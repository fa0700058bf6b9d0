//! The step from what was shown to what rays see now, by no more than a pixel may change.

/// Takes every pixel back toward what it was, so far that none of its numbers differs from that by more than `most`.
/// Whether any had to.
pub fn ease(before: &[f32], rgba: &mut [f32], most: f32) -> bool {
    let mut is_behind = false;
    for (before, pixel) in before.chunks_exact(4).zip(rgba.chunks_exact_mut(4)) {
        let change = pixel.iter().zip(before).fold(0.0_f32, |change, (a, b)| change.max((a - b).abs()));
        if change > most {
            // On a straight line: a mixture of the two, of no third colour.
            let share = most / change;
            pixel.iter_mut().zip(before).for_each(|(now, before)| *now = before + share * (*now - before));
            is_behind = true;
        }
    }
    is_behind
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: f32 = 12.0 / 255.0;

    #[test]
    fn a_pixel_goes_on_evenly_on_a_straight_line_and_ends_at_what_was_cast() {
        let (start, cast) = ([0.0, 0.4, 0.5, 0.7], [0.9, 0.1, 0.5, 0.7]);
        // Two pixels, one of which stays.
        let mut last = [[0.25; 4], start].concat();
        for step in 1..=40 {
            let mut now = [[0.25; 4], cast].concat();
            // 0.9 takes 20 steps of 12/255.
            assert_eq!(ease(&last, &mut now, MOST), step < 20, "step {step}");
            assert_eq!(now[..4], [0.25; 4]);
            let change = now.iter().zip(&last).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
            assert!(change <= MOST + 1e-6, "step {step}: {change}");
            assert!((now[5] - (0.4 - now[4] / 3.0)).abs() < 1e-6, "a third colour: {now:?}");
            assert_eq!(now[4..] == cast, step >= 20);
            last = now;
        }
    }
}
