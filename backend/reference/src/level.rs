//! The fractional level of samples: the one they are filtered at, or what the corners of their leaf ask for.

use super::{Line, corners::Corners};
use bricks::LodRule;
use glam::DVec3;

/// λ of [`optics::Quality::quadrilinear`] over the volume: log2(lod_scale · s(z) / longest edge of the finest
/// voxel) levels above the finest, with s(z) = s0 + 2 |z| tan(Φ/2).
#[derive(Clone, Copy, Debug)]
pub struct FilterLevel {
    /// lod_scale over the longest edge of the finest voxel, 1/metre.
    scale: f64,
    /// s0, metres.
    pixel_m: f64,
    /// 2 tan(Φ/2).
    spread: f64,
    /// z in the display frame of a point p of the volume frame is `row · p + offset`.
    row: DVec3,
    offset: f64,
}

impl FilterLevel {
    /// What `rule` asks for.
    pub fn new(rule: &LodRule) -> Self {
        let linear = rule.display_from_volume.matrix3;
        let longest = linear.x_axis.length().max(linear.y_axis.length()).max(linear.z_axis.length());
        Self {
            scale: rule.lod_scale / longest,
            pixel_m: rule.pixel_size_m,
            spread: 2.0 * (0.5 * rule.angular_accuracy).tan(),
            row: linear.row(2),
            offset: rule.display_from_volume.translation.z,
        }
    }

    /// λ − ℓ at a point of the volume, for a node ℓ = `level` levels above the finest; −∞ where lod_scale is 0.
    pub fn above(&self, point: DVec3, level: u8) -> f64 {
        let z = self.row.dot(point) + self.offset;
        (self.scale * (self.pixel_m + self.spread * z.abs())).log2() - f64::from(level)
    }

    /// The t of a line at which it is not smooth: where the line crosses the screen, and where λ − ℓ is 0, 1 or 2.
    pub fn kinks(&self, line: &Line, level: u8) -> impl Iterator<Item = f64> {
        let (start, speed) = (self.row.dot(line.origin) + self.offset, self.row.dot(line.direction));
        let depth = |above: u8| {
            let resolution_m = 2.0_f64.powi(i32::from(level + above)) / self.scale;
            (resolution_m - self.pixel_m) / self.spread
        };
        let depths = [0, 1, 2].map(depth);
        let both = depths.into_iter().flat_map(|z| [z, -z]);
        both.chain([0.0]).map(move |z| (z - start) / speed)
    }
}

/// What the samples of one leaf are blended by.
#[derive(Clone, Copy)]
pub struct Blending<'a> {
    /// The level that they are filtered at.
    pub filter: Option<&'a FilterLevel>,
    /// The weights of the leaf's corners, where the parent has any share.
    pub corners: Option<&'a Corners>,
    /// The leaf's level.
    pub level: u8,
}

impl Blending<'_> {
    /// Levels above the leaf at a point; at or below 0 it is the leaf alone.
    pub fn above(&self, point: DVec3) -> f64 {
        self.filtered(point).max(self.corners.map_or(0.0, |corners| corners.parents_share(point)))
    }

    /// The t of a line between which it is smooth, but where filter and corners ask for the same.
    pub fn kinks(&self, line: &Line) -> impl Iterator<Item = f64> {
        self.filter.into_iter().flat_map(|filter| filter.kinks(line, self.level))
    }

    /// Whether it may vary between two kinks, on a way with `point` on it, in a leaf with `top` levels above it.
    pub fn varies(&self, point: DVec3, top: f64) -> bool {
        let filtered = self.filtered(point);
        (filtered > 0.0 && filtered < top) || (self.corners.is_some() && filtered < 1.0 && top > 0.0)
    }

    fn filtered(&self, point: DVec3) -> f64 {
        self.filter.map_or(0.0, |filter| filter.above(point, self.level))
    }
}
