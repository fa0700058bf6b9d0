//! A cubic of u in [0, 1], in Bernstein form: its values stay within its coefficients.

use glam::{DMat3, DVec3};

/// b0 (1−u)³ + 3 b1 (1−u)² u + 3 b2 (1−u) u² + b3 u³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic(pub [f64; 4]);

impl Cubic {
    /// The same value everywhere.
    pub fn constant(value: f64) -> Self {
        Self([value; 4])
    }

    /// The cubic through the values at u = 0, 1/3, 2/3 and 1.
    pub fn through_thirds(f: [f64; 4]) -> Self {
        let [f0, f1, f2, f3] = f;
        let b1 = (-5.0 * f0 + 18.0 * f1 - 9.0 * f2 + 2.0 * f3) / 6.0;
        let b2 = (2.0 * f0 - 9.0 * f1 + 18.0 * f2 - 5.0 * f3) / 6.0;
        Self([f0, b1, b2, f3])
    }

    /// The value at `u`.
    pub fn at(&self, u: f64) -> f64 {
        let [b0, b1, b2, b3] = self.0;
        let v = 1.0 - u;
        v * v * (v * b0 + 3.0 * u * b1) + u * u * (3.0 * v * b2 + u * b3)
    }

    /// The derivative at `u`.
    pub fn slope(&self, u: f64) -> f64 {
        let [b0, b1, b2, b3] = self.0;
        let v = 1.0 - u;
        3.0 * (v * v * (b1 - b0) + 2.0 * v * u * (b2 - b1) + u * u * (b3 - b2))
    }

    /// The integral from 0 to `u`.
    pub fn integral(&self, u: f64) -> f64 {
        let [b0, b1, b2, b3] = self.0;
        let v = 1.0 - u;
        let (d2, d3, d4) = (b0 + b1, b0 + b1 + b2, b0 + b1 + b2 + b3);
        0.25 * u * (4.0 * v * v * v * b0 + 6.0 * v * v * u * d2 + 4.0 * v * u * u * d3 + u * u * u * d4)
    }

    /// An interval that holds every value.
    pub fn bounds(&self) -> (f64, f64) {
        let [b0, b1, b2, b3] = self.0;
        (b0.min(b1).min(b2.min(b3)), b0.max(b1).max(b2.max(b3)))
    }

    /// Whether every coefficient is a finite number.
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|b| b.is_finite())
    }

    /// `(self − origin) / unit`.
    pub fn relative_to(&self, origin: f64, unit: f64) -> Self {
        Self(self.0.map(|b| (b - origin) / unit))
    }

    /// `offset + scale · self`.
    pub fn scaled(&self, offset: f64, scale: f64) -> Self {
        Self(self.0.map(|b| offset + scale * b))
    }

    /// The vector-valued cubic `matrix · vector`.
    pub fn transformed(matrix: &DMat3, vector: &[Self; 3]) -> [Self; 3] {
        let columns: [DVec3; 4] =
            std::array::from_fn(|i| *matrix * DVec3::from_array(vector.map(|cubic| cubic.0[i])));
        std::array::from_fn(|axis| Self(columns.map(|column| column[axis])))
    }

    /// `self + (other − self) t`.
    pub fn lerp(&self, other: &Self, t: f64) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + (other.0[i] - self.0[i]) * t))
    }

    /// The same cubic on [a, b], as a cubic on [0, 1] (its blossom at the mixed arguments of a and b).
    pub fn part(&self, a: f64, b: f64) -> Self {
        if a == 0.0 && b == 1.0 {
            return *self;
        }
        Self([self.blossom(a, a, a), self.blossom(a, a, b), self.blossom(a, b, b), self.blossom(b, b, b)])
    }

    /// Where its slope changes sign in (0, 1), in rising order.
    pub fn turning_points(&self) -> impl Iterator<Item = f64> + use<> {
        let [b0, b1, b2, b3] = self.0;
        let (first, middle, last) = (b1 - b0, b2 - b1, b3 - b2);
        let one_way = first.min(middle).min(last) >= 0.0 || first.max(middle).max(last) <= 0.0;
        let (square, half_linear) = (first - 2.0 * middle + last, middle - first);
        let discriminant = half_linear * half_linear - square * first;
        let mut roots = [f64::NAN; 2];
        if !one_way && discriminant > 0.0 {
            let q = -(half_linear + discriminant.sqrt().copysign(half_linear));
            roots = [q / square, first / q];
            if roots[0] > roots[1] {
                roots.swap(0, 1);
            }
        }
        roots.into_iter().filter(|&u| u > 0.0 && u < 1.0)
    }

    /// Where it takes the value `level` in [a, b], on which it must be monotone: Newton's method kept in a bracket.
    pub fn crossing(&self, a: f64, b: f64, level: f64) -> f64 {
        let is_rising = self.at(b) >= self.at(a);
        let (mut low, mut high) = (a, b);
        let mut u = 0.5 * (a + b);
        for _ in 0..100 {
            let miss = self.at(u) - level;
            if miss == 0.0 {
                return u;
            }
            if (miss < 0.0) == is_rising {
                low = u
            } else {
                high = u
            }
            let newton = u - miss / self.slope(u);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - u).abs() <= f64::EPSILON * u {
                return next;
            }
            u = next;
        }
        u
    }

    /// Where it changes sign in (0, 1), in rising order.
    pub fn sign_changes(&self) -> impl Iterator<Item = f64> + use<> {
        let (low, high) = self.bounds();
        let may_change = low < 0.0 && high > 0.0;
        let ends = self.turning_points().chain([1.0]).filter(move |_| may_change);
        let cubic = *self;
        let mut from = 0.0;
        ends.filter_map(move |to| {
            let start = std::mem::replace(&mut from, to);
            let changes = (cubic.at(start) < 0.0) != (cubic.at(to) < 0.0);
            changes.then(|| cubic.crossing(start, to, 0.0))
        })
        .filter(|&u| u > 0.0 && u < 1.0)
    }

    /// The symmetric trilinear form that equals the cubic on its diagonal.
    fn blossom(&self, x: f64, y: f64, z: f64) -> f64 {
        let lerp = |a: f64, b: f64, t: f64| (1.0 - t) * a + t * b;
        let [b0, b1, b2, b3] = self.0;
        let (c0, c1, c2) = (lerp(b0, b1, x), lerp(b1, b2, x), lerp(b2, b3, x));
        lerp(lerp(c0, c1, y), lerp(c1, c2, y), z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBIC: fn(f64) -> f64 = |u| 1.0 - 4.0 * u + 9.0 * u * u - 5.5 * u * u * u;

    fn cubic() -> Cubic {
        Cubic::through_thirds([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(CUBIC))
    }

    #[test]
    fn reproduces_a_cubic_its_slope_its_integral_and_its_parts() {
        let part = cubic().part(0.25, 0.75);
        for u in [0.0, 0.1, 0.5, 0.93, 1.0] {
            assert!((cubic().at(u) - CUBIC(u)).abs() < 1e-14);
            assert!((cubic().slope(u) - (-4.0 + 18.0 * u - 16.5 * u * u)).abs() < 1e-13);
            let integral = u - 2.0 * u * u + 3.0 * u.powi(3) - 1.375 * u.powi(4);
            assert!((cubic().integral(u) - integral).abs() < 1e-14);
            assert!((part.at(u) - CUBIC(0.25 + 0.5 * u)).abs() < 1e-14);
        }
    }

    #[test]
    fn finds_turning_points_and_crossings() {
        let turns: Vec<f64> = cubic().turning_points().collect();
        assert_eq!(turns.len(), 2);
        assert!(turns.iter().all(|&u| cubic().slope(u).abs() < 1e-12));
        let u = cubic().crossing(turns[0], turns[1], 0.7);
        assert!(u > turns[0] && u < turns[1] && (CUBIC(u) - 0.7).abs() < 1e-14);
    }

    #[test]
    fn finds_changes_of_sign() {
        let thrice = Cubic::through_thirds(
            [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|u| (u - 0.2) * (u - 0.3) * (u - 0.9)),
        );
        let changes: Vec<f64> = thrice.sign_changes().collect();
        assert!(changes.len() == 3 && (changes[1] - 0.3).abs() < 1e-12, "{changes:?}");
        assert_eq!(Cubic([1.0, -0.1, -0.1, 1.0]).sign_changes().count(), 0);
    }

    #[test]
    fn a_straight_line_or_a_parabola_has_the_turning_points_it_has() {
        assert_eq!(Cubic([0.0, 1.0, 2.0, 3.0]).turning_points().count(), 0);
        assert_eq!(Cubic::constant(2.0).turning_points().count(), 0);
        let parabola = Cubic::through_thirds([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|u| u * (1.0 - u)));
        let turns: Vec<f64> = parabola.turning_points().collect();
        assert!(turns.len() == 1 && (turns[0] - 0.5).abs() < 1e-14, "{turns:?}");
    }
}
