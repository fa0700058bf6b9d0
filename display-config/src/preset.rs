//! The displays that come with the program.

/// The presets, as (name, text of the file). Load one by name with [`crate::Display::load`].
pub fn presets() -> &'static [(&'static str, &'static str)] {
    &[("holo72", include_str!("../presets/holo72.toml")), ("desk8", include_str!("../presets/desk8.toml"))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Display;
    use glam::{DVec2, DVec3};

    #[test]
    fn each_preset_bears_its_name() {
        for (name, text) in presets() {
            assert_eq!(Display::from_toml(text, name).unwrap().name, *name);
        }
    }

    #[test]
    fn holo72_is_as_designed() {
        let display = Display::load("holo72").unwrap();
        assert_eq!((display.width_m, display.height_m), (1.6, 0.9));
        assert_eq!((display.pixel_size_m, display.eta), (0.0015, 1.0));
        assert!((display.angular_accuracy.to_degrees() - 0.8).abs() < 1e-12);
        assert_eq!(display.observer_in_display, DVec3::new(0.0, 0.0, 3.0));
        assert_eq!(display.projectors.len(), 72);
        assert_eq!(display.projectors[0].centre_in_display, DVec3::new(-3.6, 0.0, -6.0));
        assert_eq!(display.projectors[71].centre_in_display, DVec3::new(3.6, 0.0, -6.0));
        for projector in &display.projectors {
            assert_eq!((projector.raster.width, projector.raster.height), (800, 600));
            assert!(projector.raster.covers(DVec2::new(0.8, 0.45)));
        }
    }
}
