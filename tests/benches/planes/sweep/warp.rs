//! Planes as a projector shows them.

use super::plane::{Frustum, Plane};
use crate::scene::Scene;
use display_config::BeamLaw;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Light that goes through so little is black: a ray ends there.
const LEAST_LEFT: f32 = 1e-3;
/// How far an upright raster's pixels may lie from where they should, metres.
const UPRIGHT_M: f64 = 1e-9;

/// A projector with an upright raster.
pub struct View {
    law: BeamLaw,
    observer: DVec3,
    /// The first pixel on the screen, and from one to the next, metres.
    first: DVec2,
    pitch: DVec2,
    size: [usize; 2],
}

impl View {
    /// None where its raster is not upright.
    pub fn of(scene: &Scene, view: usize) -> Option<Self> {
        let raster = &scene.display.projectors[view].raster;
        let on_screen = |x, y| scene.display.pixel_on_screen(view, x, y);
        let last = [raster.width - 1, raster.height - 1];
        let first = on_screen(0, 0);
        let pitch = on_screen(1, 1) - first;
        let expected = first + pitch * DVec2::new(last[0].into(), last[1].into());
        let observer = scene.frame.observer_in_display;
        let law = scene.display.beam_law(view, observer, scene.frame.eta).ok()?;
        let is_upright = (on_screen(last[0], last[1]) - expected).length() < UPRIGHT_M
            && (on_screen(1, 0) - first - DVec2::new(pitch.x, 0.0)).length() < UPRIGHT_M;
        let size = [raster.width as usize, raster.height as usize];
        is_upright.then_some(Self { law, observer, first, pitch, size })
    }

    /// A picture of nothing.
    pub fn picture(&self) -> Vec<f32> {
        vec![0.0; 4 * self.size[0] * self.size[1]]
    }

    /// Lays planes behind what a picture shows.
    pub fn warp(&self, frustum: &Frustum, planes: &[Plane], picture: &mut [f32]) {
        let rows = picture.par_chunks_exact_mut(4 * self.size[0]).enumerate();
        rows.for_each_init(Vec::new, |slants, (y, row)| {
            let screen_y = self.first.y + y as f64 * self.pitch.y;
            slants.clear();
            slants.extend((0..self.size[0]).map(|x| {
                let screen = DVec3::new(self.first.x + x as f64 * self.pitch.x, screen_y, 0.0);
                let origin =
                    DVec3::new(self.law.a() + self.law.b() * screen.x, self.observer.y, self.observer.z);
                let way = screen - origin;
                // Metres of the ray for each of depth.
                (way.length() / way.z.abs()) as f32
            }));
            planes.iter().for_each(|plane| self.warp_row(frustum, plane, screen_y, slants, row));
        });
    }

    fn warp_row(&self, frustum: &Frustum, plane: &Plane, screen_y: f64, slants: &[f32], picture: &mut [f32]) {
        // The ray through (x, y) of the screen is at x + z ((a + b x) - x) / observer's z, and so along y.
        let ahead = plane.z / self.observer.z;
        let x_of = |x: f64| x + ahead * (self.law.a() + self.law.b() * x - x);
        let left =
            frustum.texel(DVec2::new(x_of(self.first.x), screen_y + ahead * (self.observer.y - screen_y)));
        let step = frustum.texel(DVec2::new(x_of(self.first.x + self.pitch.x), 0.0)).x - left.x;
        let below = left.y.floor();
        let [(low, filled_low), (high, filled_high)] = [below, below + 1.0].map(|y| plane.row(y as i64));
        let filled = match [filled_low.is_empty(), filled_high.is_empty()] {
            [true, _] => filled_high,
            [_, true] => filled_low,
            _ => filled_low.start.min(filled_high.start)..filled_low.end.max(filled_high.end),
        };
        if filled.is_empty() {
            return;
        }
        let up = (left.y - below) as f32;
        let texel = |row: &[[f32; 4]], x: i64| {
            usize::try_from(x).ok().and_then(|x| row.get(x).copied()).unwrap_or_default()
        };
        let pixel_of = |texel: f64| ((texel - left.x) / step).max(0.0);
        let from = pixel_of(filled.start as f64 - 1.0).ceil() as usize;
        let to = (pixel_of(filled.end as f64).ceil() as usize).min(self.size[0]);
        for x in from..to {
            let pixel = &mut picture[4 * x..4 * x + 4];
            let left_over = 1.0 - pixel[3];
            if left_over < LEAST_LEFT {
                continue;
            }
            let u = left.x + step * x as f64;
            let column = u.floor();
            let (right, column) = ((u - column) as f32, column as i64);
            let corners =
                [texel(low, column), texel(low, column + 1), texel(high, column), texel(high, column + 1)];
            let weights = [(1.0 - right) * (1.0 - up), right * (1.0 - up), (1.0 - right) * up, right * up];
            let mut seen = [0.0_f32; 4];
            for (corner, weight) in corners.iter().zip(weights) {
                seen.iter_mut().zip(corner).for_each(|(seen, corner)| *seen += weight * corner);
            }
            let depth = seen[3] * slants[x];
            if depth <= 0.0 {
                continue;
            }
            let opacity = 1.0 - through(depth);
            // Emission over extinction is the colour; the spacing falls out.
            let share = left_over * opacity / seen[3];
            for channel in 0..3 {
                pixel[channel] += share * seen[channel];
            }
            pixel[3] += left_over * opacity;
        }
    }
}

/// exp(−x), to 3 % of what is left at x = 3 and far better below.
#[inline]
fn through(x: f32) -> f32 {
    let quarter = 0.25 * x;
    let root = 1.0 + quarter * (1.0 + quarter * (0.5 + quarter * (1.0 / 6.0)));
    let square = root * root;
    1.0 / (square * square)
}
