//! A projective map of the plane.

use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A plane projective map: (x, y, 1) ↦ M (x, y, 1), divided by the third component.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Homography(pub DMat3);

impl Homography {
    /// The image of a point. Infinite or NaN for a point on the map's horizon (third component zero).
    pub fn apply(&self, point: DVec2) -> DVec2 {
        let image = self.0 * point.extend(1.0);
        image.truncate() / image.z
    }

    /// The third component of the image before the division: the side of the horizon a point lies on is its sign.
    pub fn depth(&self, point: DVec2) -> f64 {
        (self.0 * point.extend(1.0)).z
    }

    /// The affine map of a raster of `pixels` (y down) onto an upright rectangle, lower left corner and size in metres.
    pub fn of_rectangle(pixels: DVec2, lower_left: DVec2, size: DVec2) -> Self {
        let step = size / pixels;
        Self(DMat3::from_cols(
            DVec3::new(step.x, 0.0, 0.0),
            DVec3::new(0.0, -step.y, 0.0),
            DVec3::new(lower_left.x, lower_left.y + size.y, 1.0),
        ))
    }

    /// The map of a raster of `pixels` onto four points: the images of its top left corner and on, clockwise in the
    /// raster (Heckbert 1989, square to quadrilateral). None if three of the points lie on a line.
    pub fn of_corners(pixels: DVec2, corners: [DVec2; 4]) -> Option<Self> {
        let [p0, p1, p2, p3] = corners;
        let (to_p1, to_p3, skew) = (p1 - p2, p3 - p2, p0 - p1 + p2 - p3);
        let area = to_p1.perp_dot(to_p3);
        let g = skew.perp_dot(to_p3) / area;
        let h = to_p1.perp_dot(skew) / area;
        let square =
            DMat3::from_cols((p1 - p0 + g * p1).extend(g), (p3 - p0 + h * p3).extend(h), p0.extend(1.0));
        square.is_finite().then(|| Self(square * DMat3::from_diagonal((1.0 / pixels).extend(1.0))))
    }

    /// The map back. None if the matrix is singular to rounding, or has a non-finite number.
    pub fn inverse(&self) -> Option<Self> {
        // The adjugate needs no division, and a map is the same map at any scale: so rows and columns of very
        // different magnitude (pixels and metres) cost no accuracy.
        let DMat3 { x_axis, y_axis, z_axis } = self.0;
        let rows = [y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis)];
        let adjugate = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        let scale = adjugate.to_cols_array().into_iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        let determinant = x_axis.dot(rows[0]);
        let magnitude = x_axis.length() * y_axis.length() * z_axis.length();
        let regular =
            determinant.is_finite() && determinant.abs() > SINGULAR * magnitude && scale.is_finite();
        // The sign of the determinant makes depth(inverse) = 1 / depth(map) up to a positive factor.
        regular.then(|| Self(adjugate * (determinant.signum() / scale)))
    }
}

/// Below this share of the product of the columns' lengths a determinant is rounding, not a number.
const SINGULAR: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Two composed maps of numbers near 1000 lose no more than this, relative.
    const ROUND_TRIP: f64 = 1e-9;

    fn jittered_corners() -> impl Strategy<Value = [DVec2; 4]> {
        prop::array::uniform8(-0.2f64..0.2).prop_map(|j| {
            [
                DVec2::new(-0.8 + j[0], 0.45 + j[1]),
                DVec2::new(0.8 + j[2], 0.45 + j[3]),
                DVec2::new(0.8 + j[4], -0.45 + j[5]),
                DVec2::new(-0.8 + j[6], -0.45 + j[7]),
            ]
        })
    }

    proptest! {
        #![proptest_config(crate::fixed_seed::config())]

        #[test]
        fn corners_go_to_corners_and_back(corners in jittered_corners(), x in 0.0f64..800.0, y in 0.0f64..600.0) {
            let map = Homography::of_corners(DVec2::new(800.0, 600.0), corners).unwrap();
            let pixels = [(0.0, 0.0), (800.0, 0.0), (800.0, 600.0), (0.0, 600.0)];
            for ((px, py), corner) in pixels.into_iter().zip(corners) {
                prop_assert!((map.apply(DVec2::new(px, py)) - corner).length() < ROUND_TRIP);
            }
            let pixel = DVec2::new(x, y);
            let back = map.inverse().unwrap().apply(map.apply(pixel));
            prop_assert!((back - pixel).length() < ROUND_TRIP * 1000.0);
        }
    }

    #[test]
    fn a_rectangle_is_upright() {
        let map =
            Homography::of_rectangle(DVec2::new(4.0, 2.0), DVec2::new(-1.0, -0.5), DVec2::new(2.0, 1.0));
        assert_eq!(map.apply(DVec2::ZERO), DVec2::new(-1.0, 0.5));
        assert_eq!(map.apply(DVec2::new(4.0, 2.0)), DVec2::new(1.0, -0.5));
    }

    #[test]
    fn singular_maps_have_no_inverse() {
        let flat = DMat3::from_cols(DVec3::X, DVec3::X, DVec3::Z);
        assert_eq!(Homography(flat).inverse(), None);
        assert_eq!(Homography(DMat3::ZERO).inverse(), None);
        assert_eq!(Homography(DMat3::NAN).inverse(), None);
    }

    #[test]
    fn the_inverse_keeps_the_side_of_the_horizon() {
        let mirrored = Homography(DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)));
        let negated = Homography(-mirrored.0);
        assert!(mirrored.inverse().unwrap().depth(DVec2::ONE) > 0.0);
        assert!(negated.inverse().unwrap().depth(DVec2::ONE) < 0.0);
    }
}
