//! What is told of a registration, to people and to programs.

use super::expected::{ExpectedError, expected_errors};
use display_config::Display;
use glam::{DQuat, DVec3};
use serde::Serialize;
use tracking::{Handedness, PointPair, Registration};

/// A scale that is off by more makes a warning.
const MOST_SCALE_ERROR: f64 = 0.01;
/// With fewer pairs residuals say little.
const FEW: usize = 4;

/// A pair and how far its points are apart.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairSummary {
    /// What the file calls it.
    pub name: String,
    /// Metres.
    pub residual_m: f64,
}

/// A tracker's registration.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrackerSummary {
    /// The pairs, in the order of their file.
    pub pairs: Vec<PairSummary>,
    /// From the tracker's axes to the display's: a unit quaternion x y z w.
    pub rotation: DQuat,
    /// After the rotation, metres.
    pub translation_m: DVec3,
    /// Root mean square of the residuals, metres.
    pub rms_m: f64,
    /// The display's lengths over the tracker's.
    pub scale: f64,
    /// Expected errors of the transform.
    pub expected_errors: Vec<ExpectedError>,
    /// Sentences about what may be wrong.
    pub warnings: Vec<String>,
}

impl TrackerSummary {
    /// The summary of some pairs' registration; a display adds the places where its people are.
    pub fn new(pairs: &[PointPair], found: &Registration, display: Option<&Display>) -> Self {
        let pair =
            |(pair, &residual_m): (&PointPair, &f64)| PairSummary { name: pair.name.clone(), residual_m };
        Self {
            pairs: pairs.iter().zip(&found.residuals_m).map(pair).collect(),
            rotation: found.display_from_tracker.rotation,
            translation_m: found.display_from_tracker.translation_m,
            rms_m: found.rms_m,
            scale: found.scale,
            expected_errors: expected_errors(found, display),
            warnings: warnings(found),
        }
    }

    /// A table of the residuals, and a line for each figure.
    pub fn text(&self) -> String {
        let names = self.pairs.iter().map(|pair| pair.name.chars().count()).max().unwrap_or(0);
        let width = names.max("pair".len());
        let row = |pair: &PairSummary| format!("{:<width$}{:>12.2}\n", pair.name, 1e3 * pair.residual_m);
        let head = format!("{:<width$}{:>12}\n", "pair", "residual, mm");
        let rows: String = self.pairs.iter().map(row).collect();
        let largest_m = self.pairs.iter().map(|pair| pair.residual_m).fold(0.0, f64::max);
        let expected = |expected: &ExpectedError| {
            format!("expected error {:.2} mm at {}\n", 1e3 * expected.error_m, expected.place)
        };
        let expected: String = self.expected_errors.iter().map(expected).collect();
        let (rms_mm, largest_mm, scale) = (1e3 * self.rms_m, 1e3 * largest_m, self.scale);
        format!(
            "{head}{rows}\n{rms_mm:.2} mm RMS, largest {largest_mm:.2} mm; best scale {scale:.4}\n{expected}"
        )
    }
}

fn warnings(found: &Registration) -> Vec<String> {
    let mut warnings = Vec::new();
    if found.handedness == Handedness::Unclear {
        let sentence = "all points lie nearly in one plane, so they do not tell whether the tracker's axes are left-handed; \
                        if they are, tools before that plane seem to be behind it: add a point well before it";
        warnings.push(sentence.to_owned());
    }
    if (found.scale - 1.0).abs() > MOST_SCALE_ERROR {
        let percent = 100.0 * (found.scale - 1.0);
        warnings.push(format!(
            "the points are {:.1} % {} in the display frame than in the tracker's; check the tracker's own calibration and \
             the screen's size",
            percent.abs(),
            if percent > 0.0 { "farther apart" } else { "nearer to each other" }
        ));
    }
    if found.residuals_m.len() < FEW {
        warnings.push("three pairs leave little to check by; measure more".to_owned());
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracking::register;

    /// Marks that a tracker sees where they are, in other axes, stretched.
    fn summary(marks: &[DVec3], stretch: f64, display: Option<&Display>) -> TrackerSummary {
        let pair = |(at, &mark): (usize, &DVec3)| PointPair {
            name: ["a", "lower left"][at % 2].to_owned(),
            point_in_tracker: DVec3::new(mark.z, mark.x, mark.y) / stretch,
            point_in_display: mark,
        };
        let pairs: Vec<_> = marks.iter().enumerate().map(pair).collect();
        TrackerSummary::new(&pairs, &register(&pairs).unwrap(), display)
    }

    const FLAT: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    const SOLID: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];

    #[test]
    fn residuals_are_a_table_and_errors_are_told_where_people_are() {
        let display = Display::load("holo72").unwrap();
        let text = summary(&SOLID, 1.005, Some(&display)).text();
        let lines: Vec<_> = text.lines().collect();
        assert!(lines[0].starts_with("pair ") && lines[2].starts_with("lower left "), "{text}");
        assert!(lines[..5].iter().all(|line| line.chars().count() == lines[0].chars().count()), "{text}");
        assert!(lines[6].contains("mm RMS") && lines[6].contains("best scale 1.0050"), "{text}");
        let edges: Vec<_> = lines.iter().filter(|line| line.contains("the viewing zone's")).collect();
        assert_eq!(edges.len(), 2, "{text}");
    }

    #[test]
    fn doubts_are_warnings() {
        let warnings = |marks: &[DVec3], stretch: f64| summary(marks, stretch, None).warnings.join("; ");
        assert_eq!(warnings(&SOLID, 1.0), "");
        let flat = warnings(&FLAT, 1.0);
        assert!(flat.contains("left-handed") && flat.contains("three pairs"), "{flat}");
        let (far, near) = (warnings(&SOLID, 1.02), warnings(&SOLID, 0.98));
        assert!(far.contains("2.0 % farther apart") && near.contains("2.0 % nearer"), "{far} {near}");
    }
}
