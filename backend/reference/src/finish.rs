//! A projector's codes for a picture in f64: warp, blend, black level, transfer curve, dither, each by its formula.

use display_config::{BlackLevel, Finish, LightMap, Projector, Raster, Response, Transfer};
use glam::DVec2;

/// A place this far outside a picture (pixels) still belongs to it: a mesh has its points in f32.
const EDGE_PX: f64 = 1e-3;

/// How a picture is read between its pixel centres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Linear along both axes.
    Bilinear,
    /// The interpolating cubic convolution of Keys (1981) with a = −1/2.
    Cubic,
}

impl Filter {
    /// The kernel at a distance from a pixel's centre, along one axis.
    fn weight(self, distance: f64) -> f64 {
        let d = distance.abs();
        match self {
            Self::Bilinear => (1.0 - d).max(0.0),
            Self::Cubic if d < 1.0 => 1.5 * d.powi(3) - 2.5 * d.powi(2) + 1.0,
            Self::Cubic if d < 2.0 => -0.5 * d.powi(3) + 2.5 * d.powi(2) - 4.0 * d + 2.0,
            Self::Cubic => 0.0,
        }
    }
}

/// What a projector should be sent for a picture.
pub struct FinishTruth<'a> {
    finish: &'a Finish,
    raster: &'a Raster,
    /// Four numbers to a pixel.
    rgba: &'a [f32],
    filter: Filter,
}

impl<'a> FinishTruth<'a> {
    /// For the picture that was drawn on the raster of a projector.
    pub fn new(projector: &'a Projector, rgba: &'a [f32], filter: Filter) -> Self {
        Self { finish: &projector.finish, raster: &projector.raster, rgba, filter }
    }

    /// The light of a pixel after the warp; None where it sees none of the picture.
    pub fn warped(&self, x: u32, y: u32) -> Option<[f64; 3]> {
        let Some(mesh) = &self.finish.mesh else { return Some(self.drawn(i64::from(x), i64::from(y))) };
        let size = DVec2::new(f64::from(self.raster.width), f64::from(self.raster.height));
        let share = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / size;
        // The sum of all points, each with the hat that reaches to its neighbours.
        let [columns, rows] = mesh.size();
        let hat = |share: f64, along: u32, i: u32| {
            (1.0 - (share * f64::from(along - 1) - f64::from(i)).abs()).max(0.0)
        };
        let mut screen = DVec2::ZERO;
        for (point, i) in mesh.points().iter().zip(0..) {
            let weight = hat(share.x, columns, i % columns) * hat(share.y, rows, i / columns);
            screen += weight * point.as_dvec2();
        }
        let image = self.raster.screen_from_pixel.0.inverse() * screen.extend(1.0);
        let place = image.truncate() / image.z;
        let is_seen = place.x >= -EDGE_PX
            && place.y >= -EDGE_PX
            && place.x <= size.x + EDGE_PX
            && place.y <= size.y + EDGE_PX;
        is_seen.then(|| self.between(place - 0.5))
    }

    /// The picture between its pixel centres; pixels beyond the rim are those at it. No light is below black.
    fn between(&self, place: DVec2) -> [f64; 3] {
        let (x, y) = (place.x.floor() as i64, place.y.floor() as i64);
        let mut sum = [0.0; 3];
        for row in y - 1..=y + 2 {
            for column in x - 1..=x + 2 {
                let weight =
                    self.filter.weight(place.x - column as f64) * self.filter.weight(place.y - row as f64);
                let colour = self.drawn(column, row);
                (0..3).for_each(|c| sum[c] += weight * colour[c]);
            }
        }
        sum.map(|channel: f64| channel.max(0.0))
    }

    fn drawn(&self, x: i64, y: i64) -> [f64; 3] {
        let within = |place: i64, count: u32| place.clamp(0, i64::from(count) - 1) as usize;
        let at = within(y, self.raster.height) * self.raster.width as usize + within(x, self.raster.width);
        std::array::from_fn(|c| f64::from(self.rgba[4 * at + c]))
    }

    /// The linear light of a pixel, from 0 to 1, before the transfer curve.
    pub fn light(&self, x: u32, y: u32) -> [f64; 3] {
        let share = |map: &LightMap| self.share(map, x, y);
        let blend = self.finish.blend.as_ref().map_or(1.0, share);
        let black = match &self.finish.black {
            None => [0.0; 3],
            Some(BlackLevel::Level(level)) => level.map(f64::from),
            Some(BlackLevel::Map(map)) => [share(map); 3],
        };
        let warped = self.warped(x, y).unwrap_or_default();
        std::array::from_fn(|c| black[c] + (1.0 - black[c]) * blend * warped[c].clamp(0.0, 1.0))
    }

    /// A map that lies over the raster, bilinear between the centres of its pixels.
    fn share(&self, map: &LightMap, x: u32, y: u32) -> f64 {
        let along = |pixel: u32, count: u32, map_count: u32| {
            let place = (f64::from(pixel) + 0.5) * f64::from(map_count) / f64::from(count) - 0.5;
            place.clamp(0.0, f64::from(map_count) - 1.0)
        };
        let [width, height] = map.size();
        let place = (along(x, self.raster.width, width), along(y, self.raster.height, height));
        let weight = |i: u32| {
            Filter::Bilinear.weight(place.0 - f64::from(i % width))
                * Filter::Bilinear.weight(place.1 - f64::from(i / width))
        };
        map.shares().iter().zip(0..).map(|(&share, i)| weight(i) * f64::from(share) / 65535.0).sum()
    }

    /// The darkest and the brightest code that a pixel may have if its light is known to `tolerance`.
    pub fn codes(&self, x: u32, y: u32, tolerance: f64) -> [[u8; 2]; 3] {
        let light = self.light(x, y);
        let code = |channel: usize, light: f64| {
            let code = self.code(channel, light.clamp(0.0, 1.0));
            match self.finish.is_dithered {
                false => code.round() as u8,
                true => self.dithered(channel, light.clamp(0.0, 1.0), code, bayer(x % 32, y % 32, 32)),
            }
        };
        std::array::from_fn(|c| [light[c] - tolerance, light[c] + tolerance].map(|light| code(c, light)))
    }

    /// The code for a light, not rounded.
    fn code(&self, channel: usize, light: f64) -> f64 {
        match &self.finish.transfer {
            Transfer::Srgb if light <= 0.003_130_8 => 255.0 * 12.92 * light,
            Transfer::Srgb => 255.0 * (1.055 * light.powf(1.0 / 2.4) - 0.055),
            Transfer::Gamma(gamma) => 255.0 * light.powf(1.0 / gamma),
            Transfer::Measured(responses) => inverted(&responses[channel], light),
        }
    }

    /// The least light whose code, not rounded, is enough: by bisection, since the curve rises, so that no curve needs a
    /// second formula.
    fn least(&self, channel: usize, is_enough: impl Fn(f64) -> bool) -> f64 {
        let (mut low, mut high) = (0.0, 8.0);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if is_enough(self.code(channel, middle)) { high = middle } else { low = middle }
        }
        high
    }

    /// The code below or above, so that their mean light over many pixels is the light. The lowest code of a measured curve is
    /// that of all light up to its own.
    fn dithered(&self, channel: usize, light: f64, code: f64, rank: u32) -> u8 {
        let below = (code + 1e-9).floor();
        let low = self.least(channel, |code| code > below);
        let high = self.least(channel, |code| code >= below + 1.0);
        let is_above = (light - low) / (high - low) > (f64::from(rank) + 0.5) / 1024.0;
        below as u8 + u8::from(is_above && below < 255.0)
    }
}

/// The inverse of a measured curve: straight between its knots, the same beyond them.
fn inverted(response: &Response, light: f64) -> f64 {
    let knots = response.knots();
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let part = knots.windows(2).find(|pair| (pair[0].0..pair[1].0).contains(&light));
    match part {
        Some(pair) => {
            let share = (light - pair[0].0) / (pair[1].0 - pair[0].0);
            f64::from(pair[0].1) + share * f64::from(pair[1].1 - pair[0].1)
        }
        None => f64::from(if light < first.0 { first.1 } else { last.1 }),
    }
}

/// The rank of a place in Bayer's matrix of an edge, which is made of four times that of half the edge.
fn bayer(x: u32, y: u32, edge: u32) -> u32 {
    let half = edge / 2;
    match half {
        0 => 0,
        _ => 4 * bayer(x % half, y % half, half) + [[0, 2], [3, 1]][(y / half) as usize][(x / half) as usize],
    }
}
