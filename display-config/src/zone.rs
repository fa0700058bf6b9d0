//! The viewing zone: from where the whole screen is lit.

use crate::Display;
use crate::beams::Beams;
use glam::DVec2;

/// Screen points sampled along each axis, edges included. If every projector covers the whole screen, the edges alone
/// decide and the zone is exact; if rasters tile the screen, it is as fine as this grid.
const SAMPLES: u32 = 33;

impl Display {
    /// The x interval, metres, from which the whole screen is lit at a distance from it: an eye there lies,
    /// for every screen point, between the outermost beams through it. None if there is no such place.
    pub fn viewing_zone(&self, distance_m: f64) -> Option<(f64, f64)> {
        zone_of(DVec2::new(self.width_m, self.height_m), &Beams::new(self), distance_m)
    }
}

pub(crate) fn zone_of(screen_size: DVec2, beams: &Beams, distance_m: f64) -> Option<(f64, f64)> {
    if !distance_m.is_finite() || distance_m <= 0.0 {
        return None;
    }
    let mut zone = (f64::NEG_INFINITY, f64::INFINITY);
    for screen in screen_grid(screen_size) {
        let (low, high) = beams.fan_at(screen)?;
        zone.0 = zone.0.max(screen.x + distance_m * low);
        zone.1 = zone.1.min(screen.x + distance_m * high);
    }
    (zone.0 <= zone.1).then_some(zone)
}

fn screen_grid(size: DVec2) -> impl Iterator<Item = DVec2> {
    let share = |i: u32| f64::from(i) / f64::from(SAMPLES - 1) - 0.5;
    (0..SAMPLES).flat_map(move |y| (0..SAMPLES).map(move |x| DVec2::new(share(x), share(y)) * size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Homography;

    fn assert_zone(display: &Display, distance_m: f64, half_width_m: f64) {
        let (low, high) = display.viewing_zone(distance_m).unwrap();
        assert!((low + half_width_m).abs() < 1e-9 && (high - half_width_m).abs() < 1e-9, "{low} to {high}");
    }

    #[test]
    fn holo72_is_seen_over_1_2_metres_at_3_and_3_at_5() {
        let display = Display::load("holo72").unwrap();
        assert_zone(&display, 3.0, 0.6);
        // −0.8 + 5 (3.6 − 0.8) / 6 = 1.533…: ±1.5 m.
        assert_zone(&display, 5.0, 23.0 / 15.0);
    }

    #[test]
    fn every_preset_is_seen_whole_by_its_observer() {
        for (name, _) in crate::presets() {
            let display = Display::load(name).unwrap();
            let observer = display.observer_in_display;
            let (low, high) = display.viewing_zone(observer.z).unwrap();
            assert!(low < observer.x && observer.x < high, "{name}: {low} to {high}");
        }
    }

    #[test]
    fn too_near_there_is_no_zone() {
        let display = Display::load("holo72").unwrap();
        assert_eq!(display.viewing_zone(1.0), None);
        assert_eq!(display.viewing_zone(0.0), None);
        assert_eq!(display.viewing_zone(f64::NAN), None);
    }

    #[test]
    fn an_unlit_part_of_the_screen_leaves_no_zone() {
        let mut display = Display::load("desk8").unwrap();
        let half = DVec2::new(display.width_m / 2.0, display.height_m);
        for projector in &mut display.projectors {
            let lower_left = DVec2::new(-display.width_m / 2.0, -display.height_m / 2.0);
            projector.raster.screen_from_pixel =
                Homography::of_rectangle(projector.raster.size(), lower_left, half);
        }
        assert_eq!(display.viewing_zone(1.2), None);
    }
}
