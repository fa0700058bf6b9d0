//! A display: screen, observer, projectors.

use crate::{BeamLaw, CanonicalRaster, Finish, Homography, Projector, Raster, RayError, Resolution};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// The slowest and the fastest rate of a display, pictures per second.
pub const RATES_HZ: (f64, f64) = (0.1, 1000.0);

/// A light-field display. Display frame: metres, origin at the screen's centre, x right, y up, z toward the viewers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Display {
    /// Its name.
    pub name: String,
    /// Width of the screen, metres.
    pub width_m: f64,
    /// Height of the screen, metres.
    pub height_m: f64,
    /// s0: pixel size on the screen, metres.
    pub pixel_size_m: f64,
    /// Φ: angular accuracy, radians.
    pub angular_accuracy: f64,
    /// V: the virtual observer, z > 0.
    pub observer_in_display: DVec3,
    /// η: 0 one perspective view, 1 full horizontal parallax.
    pub eta: f64,
    /// Pictures per second that its projectors show.
    pub rate_hz: f64,
    /// Its projectors, in the order of their pictures.
    pub projectors: Vec<Projector>,
    /// Part of the name of the graphics adapter of each back-end; None, or no entry, where the file names none.
    pub adapters: Vec<Option<String>>,
}

impl Display {
    /// The same display, with the finish of these projectors alone: no other is of use to who draws these.
    #[must_use]
    pub fn with_finishes_of(&self, projectors: &[u32]) -> Self {
        let mut display = self.clone();
        for (projector, index) in display.projectors.iter_mut().zip(0..) {
            if !projectors.contains(&index) {
                projector.finish = Finish::default();
            }
        }
        display
    }

    /// The same display with pictures of so many pixels, each of which covers the whole screen.
    #[must_use]
    pub fn with_rasters(&self, width: u32, height: u32) -> Self {
        let mut display = self.clone();
        let size = DVec2::new(self.width_m, self.height_m);
        let pixels = DVec2::new(f64::from(width), f64::from(height));
        for projector in &mut display.projectors {
            let screen_from_pixel = Homography::of_rectangle(pixels, -0.5 * size, size);
            projector.raster = Raster { width, height, screen_from_pixel, output: None };
        }
        display
    }

    /// What it resolves, by depth.
    pub fn resolution(&self) -> Resolution {
        Resolution { pixel_size_m: self.pixel_size_m, angular_accuracy: self.angular_accuracy }
    }

    /// The law of the rays of a projector (an index into `projectors`) for an observer and an η, which may be others
    /// than the display's own.
    ///
    /// # Errors
    /// See [`BeamLaw::new`].
    ///
    /// # Panics
    /// If there is no such projector, as a slice does.
    pub fn beam_law(&self, projector: usize, observer: DVec3, eta: f64) -> Result<BeamLaw, RayError> {
        BeamLaw::new(self.projectors[projector].centre_in_display, observer, eta)
    }

    /// The raster that all projectors share: as many pixels as the first of them has, over the whole screen; 1 × 1 if there
    /// is none.
    pub fn canonical_raster(&self) -> CanonicalRaster {
        let size = |projector: &Projector| (projector.raster.width, projector.raster.height);
        let (width, height) = self.projectors.first().map_or((1, 1), size);
        CanonicalRaster { width, height, size_m: DVec2::new(self.width_m, self.height_m) }
    }

    /// The screen point of the centre of pixel (x, y) of a projector, metres.
    ///
    /// # Panics
    /// If there is no such projector, as a slice does.
    pub fn pixel_on_screen(&self, projector: usize, x: u32, y: u32) -> DVec2 {
        self.projectors[projector].raster.pixel_on_screen(x, y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holo72() -> Display {
        Display::load("holo72").unwrap()
    }

    #[test]
    fn resolution_is_the_pixel_on_the_screen_and_grows_on_both_sides() {
        let display = holo72();
        assert_eq!(display.resolution().at(0.0), 0.0015);
        assert_eq!(display.resolution().at(0.3), display.resolution().at(-0.3));
        let blur_at_half_a_metre = 0.0015 + 0.4f64.to_radians().tan();
        assert!((display.resolution().at(0.5) - blur_at_half_a_metre).abs() < 1e-15);
    }

    #[test]
    fn the_law_is_that_of_the_named_projector() {
        let display = holo72();
        let law = display.beam_law(0, display.observer_in_display, 1.0).unwrap();
        // E = (−3.6, 0, −6), V = (0, 0, 3): k = 9/6, A = −3.6 (1 − 1.5).
        assert!((law.a() - 1.8).abs() < 1e-12 && (law.b() - 1.5).abs() < 1e-12);
    }

    #[test]
    fn pixels_lie_on_the_screen_y_up() {
        let display = holo72();
        let first = display.pixel_on_screen(71, 0, 0);
        assert!((first - DVec2::new(-0.8 + 0.001, 0.45 - 0.00075)).length() < 1e-12);
        assert!((display.pixel_on_screen(71, 799, 599) + first).length() < 1e-12);
    }
}
