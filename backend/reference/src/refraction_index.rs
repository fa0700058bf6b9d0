//! The refraction index over the scalar, cut at its knots into phases.

use optics::Curve;

/// ν(s). A phase is an interval of the scalar on which ν is linear; from one to the next its slope changes, or itself.
#[derive(Clone, Debug)]
pub struct Index {
    /// Scalars at which phases meet, in rising order.
    knots: Vec<f64>,
    /// Control points of ν in each phase; its value at the ends is that just inside.
    phases: Vec<Vec<(f64, f64)>>,
}

impl Index {
    /// Of a curve.
    pub fn new(curve: &Curve<f64>) -> Self {
        let jumps_at = |s: f64| curve.just_below(s) != curve.at(s);
        let is_knot = |&s: &f64| s > 0.0 && (s < 1.0 || s == 1.0 && jumps_at(s));
        let mut knots: Vec<f64> = curve.points().iter().map(|p| p.0).filter(is_knot).collect();
        knots.dedup();
        let starts = std::iter::once(0.0).chain(knots.iter().copied());
        let ends = knots.iter().copied().chain([1.0]);
        Self { phases: starts.zip(ends).map(|(start, end)| phase(curve, start, end)).collect(), knots }
    }

    /// The phase that holds the scalar `s`; at a knot, the upper one, as [`Curve::at`] has it.
    pub fn phase(&self, s: f64) -> usize {
        self.knots.partition_point(|&knot| knot <= s)
    }

    /// By how much the scalar `s` lies within `phase`; negative outside it.
    pub fn margin(&self, phase: usize, s: f64) -> f64 {
        let from = phase.checked_sub(1).map_or(f64::NEG_INFINITY, |below| self.knots[below]);
        let to = self.knots.get(phase).copied().unwrap_or(f64::INFINITY);
        // The upper end belongs to the next phase.
        if s < to { (s - from).min(to - s) } else { (to - s).min(-f64::MIN_POSITIVE) }
    }

    /// Whether there is more than one phase.
    pub fn has_knots(&self) -> bool {
        !self.knots.is_empty()
    }

    /// ν and dν/ds in `phase`. Beyond its ends, it goes on with the value there.
    pub fn at(&self, phase: usize, s: f64) -> (f64, f64) {
        let points = &self.phases[phase];
        let after = points.partition_point(|p| p.0 <= s);
        if after == 0 {
            return (points[0].1, 0.0);
        }
        let (s0, v0) = points[after - 1];
        match points.get(after) {
            Some(&(s1, v1)) => {
                let slope = (v1 - v0) / (s1 - s0);
                (v0 + slope * (s - s0), slope)
            }
            None => (v0, 0.0),
        }
    }
}

fn phase(curve: &Curve<f64>, start: f64, end: f64) -> Vec<(f64, f64)> {
    let mut points = vec![(start, curve.at(start))];
    if end > start {
        points.extend(curve.points().iter().filter(|p| p.0 > start && p.0 < end));
        points.push((end, curve.just_below(end)));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_end_where_the_index_jumps_or_its_slope_does() {
        let curve = Curve::new(vec![(0.2, 1.0), (0.5, 1.3), (0.5, 1.5), (1.0, 1.5), (1.0, 2.0)]).unwrap();
        let index = Index::new(&curve);
        assert_eq!([0.1, 0.5, 0.9, 1.0].map(|s| index.phase(s)), [0, 2, 2, 3]);
        let ends = (index.at(0, 0.1), index.at(1, 0.9), index.at(2, 0.1));
        assert_eq!(ends, ((1.0, 0.0), (1.3, 0.0), (1.5, 0.0)));
        let (value, slope) = index.at(1, 0.35);
        assert!((value - 1.15).abs() < 1e-15 && (slope - 1.0).abs() < 1e-15);
        assert_eq!(index.at(3, 1.0), (2.0, 0.0));
        assert_eq!([0.3, 0.1, 0.6].map(|s| (100.0 * index.margin(1, s)).round()), [10.0, -10.0, -10.0]);
        assert!(index.margin(1, 0.2) == 0.0 && index.margin(1, 0.5) < 0.0 && index.margin(3, 9.0) > 0.0);
        assert!(!Index::new(&Curve::constant(1.3)).has_knots());
    }
}
