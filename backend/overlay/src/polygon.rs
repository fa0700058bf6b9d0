//! Polygons: cut, and drawn tight about points.

use glam::DVec2;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

/// The part of a polygon where a function that is linear in its points is not negative (Sutherland and Hodgman 1974). Where that
/// is in several pieces, they stay joined by edges along the cut, which enclose nothing.
pub(crate) fn cut<P>(corners: &[P], margin: impl Fn(P) -> f64) -> Vec<P>
where
    P: Copy + Add<Output = P> + Sub<Output = P> + Mul<f64, Output = P>,
{
    let mut kept = Vec::with_capacity(corners.len() + 2);
    let Some(&last) = corners.last() else { return kept };
    let mut before = (last, margin(last));
    for &corner in corners {
        let here = (corner, margin(corner));
        if (before.1 < 0.0) != (here.1 < 0.0) {
            kept.push(before.0 + (here.0 - before.0) * (before.1 / (before.1 - here.1)));
        }
        if here.1 >= 0.0 {
            kept.push(here.0);
        }
        before = here;
    }
    kept
}

/// The same for a line from `a` to `b`: what is left of it, if anything.
pub(crate) fn cut_line<P>([a, b]: [P; 2], margin: impl Fn(P) -> f64) -> Option<[P; 2]>
where
    P: Copy + Add<Output = P> + Sub<Output = P> + Mul<f64, Output = P>,
{
    let (at_a, at_b) = (margin(a), margin(b));
    let crossing = || a + (b - a) * (at_a / (at_a - at_b));
    match (at_a >= 0.0, at_b >= 0.0) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, crossing()]),
        (false, true) => Some([crossing(), b]),
        (false, false) => None,
    }
}

/// The convex polygon about points, all turning one way (Andrew 1979). Not for NaN.
pub(crate) fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.partial_cmp(&b.x).unwrap_or(Ordering::Equal).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp_dot(point - a) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut corners = half(&mut points.iter().copied());
    corners.extend(half(&mut points.iter().rev().copied()));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[DVec2]) -> f64 {
        let next = corners.iter().cycle().skip(1);
        0.5 * corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
    }

    #[test]
    fn a_cut_leaves_the_side_that_is_not_negative() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        assert_eq!(
            cut(&square, |p| p.x - 0.25),
            [DVec2::new(0.25, 0.0), DVec2::X, DVec2::ONE, DVec2::new(0.25, 1.0)]
        );
        assert_eq!(cut(&square, |p| p.x + 1.0), square);
        assert!(cut(&square, |p| p.x - 2.0).is_empty());
        assert!((area(&cut(&square, |p| 1.5 - p.x - p.y)) - 0.875).abs() < 1e-15);
        assert_eq!(
            cut_line([DVec2::ZERO, DVec2::X], |p| 0.5 - p.x),
            Some([DVec2::ZERO, DVec2::new(0.5, 0.0)])
        );
        assert_eq!(cut_line([DVec2::ZERO, DVec2::X], |p| p.y - 0.5), None);
    }

    #[test]
    fn a_hull_turns_one_way_and_leaves_nothing_outside() {
        let points: Vec<_> =
            (0..40).map(|i| DVec2::new((f64::from(i) * 0.7).sin(), (f64::from(i) * 1.3).cos())).collect();
        let corners = hull(points.clone());
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            assert!(points.iter().all(|&p| (b - a).perp_dot(p - a) >= -1e-12));
        }
        assert!(area(&corners) > 3.0);
        assert_eq!(hull(vec![DVec2::ONE, DVec2::ONE]), [DVec2::ONE]);
    }
}
