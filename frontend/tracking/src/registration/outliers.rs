//! Pairs that do not fit to the others.

use super::PointPair;
use super::check::is_collinear;
use super::error::Outlier;
use super::fit::Fit;

/// A pair is wrong if it is so many times as far away as the others let expect: the residuals of few pairs vary much.
const GROSS: f64 = 8.0;
/// Every tracker is taken to err by this much, metres: three or four pairs may fit far better by chance.
const LEAST_ERROR_M: f64 = 0.003;
/// At most one in so many pairs can be wrong; otherwise nobody can say which.
const ONE_IN: usize = 3;
/// The others need so many pairs to be believed.
const FEWEST_OTHERS: usize = 3;

/// The pairs that are grossly wrong, and the RMS of the others without them, metres; None where there are none, or too
/// many to say which.
///
/// Pairs are taken away one after another, each time the one without which the others fit best. That finds several that
/// hide each other, as each of them makes the fit worse for all.
pub(super) fn outliers(pairs: &[PointPair]) -> Option<(Vec<Outlier>, f64)> {
    let mut others: Vec<&PointPair> = pairs.iter().collect();
    let mut removed = Vec::new();
    let mut found = None;
    let most = (pairs.len() / ONE_IN).min(pairs.len().saturating_sub(FEWEST_OTHERS));
    for _ in 0..most {
        let Some(worst) = worst(&others) else { break };
        removed.push(others.remove(worst));
        let fit = Fit::of(&others);
        if removed.iter().all(|pair| is_gross(&fit, pair)) {
            let outlier =
                |pair: &&PointPair| Outlier { name: pair.name.clone(), distance_m: fit.distance_m(pair) };
            found = Some((removed.iter().map(outlier).collect(), fit.rms_m));
        }
    }
    found
}

/// The place of the pair without which the others fit best and are not on a line.
fn worst(pairs: &[&PointPair]) -> Option<usize> {
    let without = |place: usize| {
        let mut others = pairs.to_vec();
        others.remove(place);
        (!is_collinear(&others)).then(|| (place, Fit::of(&others).rms_m))
    };
    (0..pairs.len()).filter_map(without).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Whether a pair that the fit has not seen is farther away than its own error and that of the fit explain.
fn is_gross(fit: &Fit, pair: &PointPair) -> bool {
    let expected_m = fit.point_error_m().max(LEAST_ERROR_M) * fit.gain_at(pair.point_in_display).hypot(1.0);
    fit.distance_m(pair) > GROSS * expected_m
}
