//! Displays whose projectors do not stand as evenly as a preset's.

use crate::random::Random;
use display_config::{Display, Homography};
use glam::DVec2;

/// How far a corner of a raster is from where it should be, at most, as a share of the screen's width.
const MOST_OFF: f64 = 0.02;
/// How much larger rasters are than the screen, and how far they are turned at most, radians.
const LARGER: f64 = 1.04;
const MOST_TURN: f64 = 0.03;

/// The display with projectors calibrated as if by hand: each raster a little larger than the screen, turned, and drawn at its
/// corners, no two alike.
pub fn calibrated(mut display: Display, seed: u64) -> Display {
    let mut random = Random(seed);
    let mut even = || random.below(1 << 20) as f64 / f64::from(1 << 19) - 1.0;
    let half = DVec2::new(display.width_m, display.height_m) / 2.0;
    for projector in &mut display.projectors {
        let turn = DVec2::from_angle(MOST_TURN * even());
        let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, y)| {
            let off = MOST_OFF * display.width_m * DVec2::new(even(), even());
            turn.rotate(LARGER * half * DVec2::new(x, y)) + off
        });
        projector.raster.screen_from_pixel =
            Homography::of_corners(projector.raster.size(), corners).expect("a quadrilateral");
    }
    display
}

/// The display with projectors in rows, one behind the other: each is so many hundredths of its distance from the screen farther.
pub fn in_rows(mut display: Display, rows: &[f64]) -> Display {
    for (projector, farther) in display.projectors.iter_mut().zip(rows.iter().cycle()) {
        projector.centre_in_display.z *= 1.0 + farther / 100.0;
    }
    display
}
