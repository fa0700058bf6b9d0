//! Which settings no other one beats.

/// Timings repeat to about this share on a quiet machine: one setting is faster than another where it takes this much
/// less.
pub const BEATEN_BY: f64 = 0.05;

/// What a setting costs and what it misses; both are better where they are smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Seconds of a cast.
    pub seconds: f64,
    /// Its error.
    pub error: f64,
}

/// The Pareto front, as indices by rising seconds: no other setting is as fast and as exact, and better in one of them. Of
/// equal ones all are on it; one whose error is not a number never is.
pub fn front(scores: &[Score]) -> Vec<usize> {
    let is_number = |score: &Score| score.seconds.is_finite() && score.error.is_finite();
    let mut order: Vec<usize> = (0..scores.len()).filter(|&i| is_number(&scores[i])).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (&scores[a], &scores[b]);
        a.seconds.total_cmp(&b.seconds).then(a.error.total_cmp(&b.error))
    });
    let mut best: Option<Score> = None;
    order.retain(|&i| {
        let is_better = best.is_none_or(|best| scores[i].error < best.error || scores[i] == best);
        if is_better {
            best = Some(scores[i]);
        }
        is_better
    });
    order
}

/// The settings that beat the one at `index` beyond the noise of timing: at least [`BEATEN_BY`] faster and more exact. It
/// lies on the front, as far as is known, if there are none.
pub fn beaten_by(scores: &[Score], index: usize) -> Vec<usize> {
    let own = scores[index];
    let is_faster = |other: &Score| other.seconds <= (1.0 - BEATEN_BY) * own.seconds;
    let is_more_exact = |other: &Score| other.error < own.error || own.error.is_nan();
    let beats = |other: &Score| other.error.is_finite() && is_faster(other) && is_more_exact(other);
    (0..scores.len()).filter(|&i| beats(&scores[i])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn scores(pairs: &[(f64, f64)]) -> Vec<Score> {
        pairs.iter().map(|&(seconds, error)| Score { seconds, error }).collect()
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let all = scores(&[
            (3.0, 1.0),
            (1.0, 5.0),
            (2.0, 6.0),
            (2.0, 2.0),
            (4.0, 1.0),
            (2.0, 2.0),
            (1.0, f64::NAN),
        ]);
        assert_eq!(front(&all), [1, 3, 5, 0]);
        assert_eq!(front(&[]), Vec::<usize>::new());
    }

    #[test]
    fn noise_does_not_beat_the_default() {
        let all = scores(&[(1.0, 1.0), (0.96, 0.5), (0.94, 1.0), (0.9, 1.1)]);
        assert_eq!(beaten_by(&all, 0), Vec::<usize>::new());
        let all = scores(&[(1.0, 1.0), (0.94, 0.99), (0.5, f64::NAN), (0.95, 0.2)]);
        assert_eq!(beaten_by(&all, 0), [1, 3]);
        assert_eq!(beaten_by(&scores(&[(1.0, f64::NAN), (0.5, 9.0)]), 0), [1]);
    }

    fn dominates(a: &Score, b: &Score) -> bool {
        a.seconds <= b.seconds && a.error <= b.error && a != b
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, rng_seed: proptest::test_runner::RngSeed::Fixed(5), failure_persistence: None, ..Default::default() })]

        #[test]
        fn a_setting_is_on_the_front_just_where_no_other_dominates_it(
            pairs in proptest::collection::vec((1u32..20, 1u32..20), 1..40)
        ) {
            let all: Vec<Score> =
                pairs.iter().map(|&(s, e)| Score { seconds: f64::from(s), error: f64::from(e) }).collect();
            let front = front(&all);
            for (i, score) in all.iter().enumerate() {
                let is_dominated = all.iter().any(|other| dominates(other, score));
                prop_assert_eq!(front.contains(&i), !is_dominated, "{:?}", score);
            }
            prop_assert!(front.is_sorted_by(|&a, &b| all[a].seconds <= all[b].seconds));
            // What lies on the front exactly lies on it within the noise, too.
            prop_assert!(front.iter().all(|&i| beaten_by(&all, i).is_empty()));
        }
    }
}
