//! A tracker's transform as the text of a file.

use serde::Serialize;
use tracking::Registration;

/// The keys that an exhibit reads.
#[derive(Serialize)]
struct TransformFile {
    /// A unit quaternion, x y z w.
    rotation: [f64; 4],
    translation_m: [f64; 3],
    rms_m: f64,
}

/// The text of a TOML file: the same registration gives the same text.
pub fn transform_text(found: &Registration) -> String {
    let transform = found.display_from_tracker;
    let file = TransformFile {
        rotation: transform.rotation.to_array(),
        translation_m: transform.translation_m.to_array(),
        rms_m: found.rms_m,
    };
    let keys = toml::to_string(&file).expect("numbers and lists of numbers are TOML");
    format!(
        "# From a tracker's frame to the display's: first turned by a quaternion x y z w, then moved.\n{keys}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use toml::Table;
    use tracking::{PointPair, register};

    #[test]
    fn what_is_written_reads_back_to_the_bit() {
        let marks = [DVec3::ZERO, DVec3::X, DVec3::new(0.1, 0.7, 0.0), DVec3::new(0.2, 0.3, 0.9)];
        let pair = |(at, mark): (usize, DVec3)| PointPair {
            name: at.to_string(),
            point_in_tracker: DVec3::new(-mark.z, mark.y, mark.x) + 0.3,
            point_in_display: mark,
        };
        let pairs: Vec<_> = marks.into_iter().enumerate().map(pair).collect();
        let found = register(&pairs).unwrap();
        let file: Table = transform_text(&found).parse().unwrap();
        let numbers = |key: &str| -> Vec<f64> {
            file[key].as_array().unwrap().iter().map(|number| number.as_float().unwrap()).collect()
        };
        assert_eq!(numbers("rotation"), found.display_from_tracker.rotation.to_array());
        assert_eq!(numbers("translation_m"), found.display_from_tracker.translation_m.to_array());
        assert_eq!(file["rms_m"].as_float(), Some(found.rms_m));
        assert_eq!(file.len(), 3);
    }
}
