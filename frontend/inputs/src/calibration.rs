//! Where a tracker is, as the text of a file: what a calibration writes, and an entry of an input file names.

use crate::pose::checked_pose;
use display_config::text::brief_text;
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use tracking::RigidTransform;

/// Its keys.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
struct TransformFile {
    /// A unit quaternion, x y z w.
    rotation: [f64; 4],
    translation_m: [f64; 3],
    /// Of the pairs that it was found from; for people.
    rms_m: f64,
}

/// The text of a TOML file: the same transform gives the same text. `rms_m` is what its point pairs are off, RMS, metres.
pub fn transform_text(display_from_tracker: &RigidTransform, rms_m: f64) -> String {
    let file = TransformFile {
        rotation: display_from_tracker.rotation.to_array(),
        translation_m: display_from_tracker.translation_m.to_array(),
        rms_m,
    };
    let keys = toml::to_string(&file).expect("numbers and lists of numbers are TOML");
    format!(
        "# From a tracker's frame to the display's: first turned by a quaternion x y z w, then moved.\n{keys}"
    )
}

/// The transform of a text, or what is wrong with it.
pub(crate) fn transform(text: &str) -> Result<RigidTransform, String> {
    let file: TransformFile = toml::from_str(text)
        .map_err(|error| brief_text(&error.message().replace('\n', ", ")).into_owned())?;
    let pose = checked_pose(DVec3::from_array(file.translation_m), DQuat::from_array(file.rotation));
    let pose = pose.map_err(|refusal| refusal.to_string())?;
    Ok(RigidTransform { rotation: pose.rotation(), translation_m: pose.position_m() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_to_the_bit() {
        let rotation = DQuat::from_xyzw(0.1, -0.2, 0.3, 0.9).normalize();
        let written = RigidTransform { rotation, translation_m: DVec3::new(0.1, -2.0, 1.0 / 3.0) };
        let text = transform_text(&written, 0.0012);
        assert_eq!(transform(&text), Ok(written));
        assert!(text.ends_with("rms_m = 0.0012\n"), "{text}");
    }

    #[test]
    fn what_is_no_transform_is_refused() {
        for (text, part) in [
            ("rotation = [0, 0, 0, 0]\ntranslation_m = [0, 0, 0]\nrms_m = 0", "its quaternion has no length"),
            ("rotation = [0, 0, 0, 1]\ntranslation_m = [0, nan, 0]\nrms_m = 0", "NaN"),
            ("rotation = [0, 0, 1]\ntranslation_m = [0, 0, 0]\nrms_m = 0", "expected an array of length 4"),
            ("rotation = [0, 0, 0, 1]\nrms_m = 0", "missing field `translation_m`"),
        ] {
            let why = transform(text).unwrap_err();
            assert!(why.contains(part), "{text}: {why}");
        }
    }
}
