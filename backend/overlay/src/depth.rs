//! How deep marks lie along the rays that meet them.

use display_config::Ray;
use glam::DVec3;
use protocol::MarkShape;

/// Where the rays of pixels meet a shape.
pub(crate) enum Depth<'a> {
    /// Discs parallel to the screen about the points of a line.
    Stroke(&'a [DVec3]),
    /// A plane: one of its points and its normal, and between which depths the surface lies in it.
    Plane { point: DVec3, normal: DVec3, z: [f64; 2] },
}

impl<'a> Depth<'a> {
    pub(crate) fn of(shape: &'a MarkShape) -> Self {
        match shape {
            MarkShape::Stroke { points_in_display, .. } => Self::Stroke(points_in_display),
            MarkShape::Sheet { corners_in_display: corners } => {
                let depths = || corners.iter().map(|corner| corner.z);
                let z = [depths().fold(f64::INFINITY, f64::min), depths().fold(f64::NEG_INFINITY, f64::max)];
                let point = corners.first().copied().unwrap_or_default();
                Self::Plane { point, normal: normal(corners), z }
            }
            MarkShape::Label { base_in_display: base, .. } => {
                Self::Plane { point: *base, normal: DVec3::Z, z: [base.z; 2] }
            }
        }
    }

    /// How far from a ray's start it meets the shape, metres. Rays that pass just beside it, whose pixels it covers in part, meet
    /// it where they are nearest.
    pub(crate) fn along(&self, ray: &Ray) -> f64 {
        let z = match self {
            Self::Stroke(points) => stroke_z(points, ray),
            Self::Plane { point, normal, z: [back, front] } => {
                let speed = ray.direction_in_display.dot(*normal);
                let distance = (*point - ray.origin_in_display).dot(*normal) / speed;
                let z = ray.at(distance).z;
                // A ray along the plane meets its edge.
                if z.is_finite() { z.clamp(*back, *front) } else { *front }
            }
        };
        (z - ray.origin_in_display.z) / ray.direction_in_display.z
    }
}

/// The normal of a polygon, of any length (Newell).
fn normal(corners: &[DVec3]) -> DVec3 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a.cross(*b)).sum()
}

/// The depth of that disc about a line's points whose middle the ray passes nearest to.
fn stroke_z(points: &[DVec3], ray: &Ray) -> f64 {
    let at_depth = |z: f64| ray.at((z - ray.origin_in_display.z) / ray.direction_in_display.z);
    let single = (points.len() == 1).then(|| [points[0]; 2]);
    let pieces = points.windows(2).map(|ends| [ends[0], ends[1]]).chain(single);
    let nearest = pieces.map(|[a, b]| {
        // How far the ray is from the line at the line's own depth goes evenly from one end to the other.
        let (from, to) = (at_depth(a.z) - a, at_depth(b.z) - b);
        let way = to - from;
        let share = (-from.dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        ((from + share * way).length_squared(), a.z + share * (b.z - a.z))
    });
    // Of pieces that are as near, the one in front.
    let found = nearest.min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    found.map_or(0.0, |(_, z)| z)
}
