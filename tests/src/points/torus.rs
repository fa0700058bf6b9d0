//! A torus: a rectangle whose opposite edges meet.

/// A place: along each edge a fraction of 2³², so that differences wrap by themselves and are exact.
pub type Place = [u32; 2];

/// The lengths of its edges, such as 4 and 3; distances are in these units times 2³².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Torus {
    /// Along x and y.
    pub edges: [u32; 2],
}

impl Torus {
    /// Fractions of an edge.
    pub const STEPS: f64 = 4_294_967_296.0;

    /// The square of the shortest distance of two places. Exact where they are close, up to about 1/64 of an edge.
    pub fn square(self, a: Place, b: Place) -> f64 {
        let along = |i: usize| f64::from(b[i].wrapping_sub(a[i]).cast_signed()) * f64::from(self.edges[i]);
        let [x, y] = [along(0), along(1)];
        x * x + y * y
    }

    /// The edge of the square that each of so many sites has for itself.
    pub fn spacing(self, sites: usize) -> f64 {
        let area = f64::from(self.edges[0]) * f64::from(self.edges[1]);
        Self::STEPS * (area / sites as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_over_the_edges() {
        let torus = Torus { edges: [4, 3] };
        let (quarter, all_but_an_eighth) = (1 << 30, 7 << 29);
        // From 1/4 back to 7/8 it is 3/8, over the edge.
        assert_eq!(torus.square([quarter, 0], [all_but_an_eighth, 0]).sqrt(), 4.0 * 0.375 * Torus::STEPS);
        assert_eq!(torus.square([0, quarter], [0, all_but_an_eighth]).sqrt(), 3.0 * 0.375 * Torus::STEPS);
        assert_eq!(torus.square([7, 9], [7, 9]), 0.0);
        assert_eq!(torus.spacing(48), 0.5 * Torus::STEPS);
    }
}
