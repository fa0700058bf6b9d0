//! Adaptive Gauss–Kronrod quadrature of a colour.

use glam::DVec3;

/// Kronrod nodes on [0, 1] side of [−1, 1]; odd entries (and the middle) are the 3-point Gauss nodes.
const NODES: [f64; 4] = [0.960_491_268_708_020_3, 0.774_596_669_241_483_4, 0.434_243_749_346_802_56, 0.0];
/// Kronrod's weights at these nodes.
const KRONROD: [f64; 4] =
    [0.104_656_226_026_467_27, 0.268_488_089_868_333_44, 0.401_397_414_775_962_2, 0.450_916_538_658_474_14];
/// Gauss's weights at the same nodes.
const GAUSS: [f64; 4] = [0.0, 5.0 / 9.0, 0.0, 8.0 / 9.0];

/// An integral, with an estimate of its error (of the worst component).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The integral.
    pub value: DVec3,
    /// Estimated absolute error.
    pub error: f64,
}

/// The integral of `f` over `[a, b]`, to the absolute `tolerance`, or as close as `max_depth` bisections bring it: then
/// the estimate says so.
pub fn integrate(f: &impl Fn(f64) -> DVec3, (a, b): (f64, f64), tolerance: f64, max_depth: u32) -> Estimate {
    let whole = rule(f, a, b);
    let middle = 0.5 * (a + b);
    // Written so that NaN ends here too.
    let wants_more = whole.error > tolerance;
    if !wants_more || max_depth == 0 || middle <= a || middle >= b {
        return whole;
    }
    let first = integrate(f, (a, middle), 0.5 * tolerance, max_depth - 1);
    let second = integrate(f, (middle, b), 0.5 * tolerance, max_depth - 1);
    Estimate { value: first.value + second.value, error: first.error + second.error }
}

/// Seven points of Kronrod against three of Gauss. Their difference is the error of Gauss's rule; Kronrod's is smaller
/// by the power law that QUADPACK uses (Piessens et al. 1983).
fn rule(f: &impl Fn(f64) -> DVec3, a: f64, b: f64) -> Estimate {
    let (centre, half) = (0.5 * (a + b), 0.5 * (b - a));
    let middle = f(centre);
    let (mut kronrod, mut gauss) = (KRONROD[3] * middle, GAUSS[3] * middle);
    let mut size = KRONROD[3] * middle.abs();
    for i in 0..3 {
        let (left, right) = (f(centre - half * NODES[i]), f(centre + half * NODES[i]));
        kronrod += KRONROD[i] * (left + right);
        gauss += GAUSS[i] * (left + right);
        size += KRONROD[i] * (left.abs() + right.abs());
    }
    let difference = ((kronrod - gauss) * half).abs().max_element();
    let size = size.max_element() * half;
    let error = if size > 0.0 { difference * (200.0 * difference / size).sqrt().min(1.0) } else { 0.0 };
    Estimate { value: kronrod * half, error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kronrod_is_exact_to_degree_eleven() {
        for degree in 0..=11 {
            let integral = rule(&|x: f64| DVec3::splat(x.powi(degree)), 0.0, 1.0).value.x;
            assert!((integral - 1.0 / f64::from(degree + 1)).abs() < 1e-15, "degree {degree}");
        }
    }

    #[test]
    fn a_kink_is_integrated_to_the_tolerance_and_a_depth_limit_is_admitted() {
        let kink = |x: f64| DVec3::splat((x - 0.3).abs());
        let exact = 0.5 * (0.3_f64.powi(2) + 0.7_f64.powi(2));
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let estimate = integrate(&kink, (0.0, 1.0), tolerance, 40);
            assert!((estimate.value.x - exact).abs() <= tolerance && estimate.error <= tolerance);
        }
        assert!(integrate(&kink, (0.0, 1.0), 1e-9, 2).error > 1e-9);
    }
}
