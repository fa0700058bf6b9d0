//! How far what is shown is from what should be.

use super::hand::Place;
use super::viewer::Shown;
use glam::{DQuat, DVec3};
use std::fmt;

/// RMS and 99th percentile.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    pub rms: f64,
    pub p99: f64,
}

/// Distances, millimetres, and angles, degrees.
#[derive(Clone, Copy, Debug)]
pub struct Score {
    pub distance_mm: Spread,
    pub angle_deg: Spread,
}

impl Score {
    /// Of what is shown against the truth.
    pub fn of_error(shown: &[Shown]) -> Self {
        Self::of(shown.iter().map(|(shown, truth)| difference(shown, truth)))
    }

    /// Of what is shown against its own mean: the jitter of a tool that is held still.
    pub fn of_jitter(shown: &[Shown]) -> Self {
        let count = shown.len() as f64;
        let mean = shown.iter().map(|((position, _), _)| *position).sum::<DVec3>() / count;
        // Rotations differ little, so that their quaternions have a mean, if one of q and −q is chosen.
        let near = |rotation: DQuat| if rotation.dot(shown[0].0.1) < 0.0 { -rotation } else { rotation };
        let sum =
            shown.iter().fold(DQuat::from_array([0.0; 4]), |sum, ((_, rotation), _)| sum + near(*rotation));
        let middle = (mean, sum.normalize());
        Self::of(shown.iter().map(|(shown, _)| difference(shown, &middle)))
    }

    fn of(differences: impl Iterator<Item = (f64, f64)>) -> Self {
        let (distances, angles) = differences.unzip();
        Self { distance_mm: spread(distances), angle_deg: spread(angles) }
    }
}

/// Millimetres and degrees.
fn difference(a: &Place, b: &Place) -> (f64, f64) {
    (1e3 * a.0.distance(b.0), a.1.angle_between(b.1).to_degrees())
}

fn spread(mut numbers: Vec<f64>) -> Spread {
    numbers.sort_by(f64::total_cmp);
    let squares: f64 = numbers.iter().map(|number| number * number).sum();
    Spread { rms: (squares / numbers.len() as f64).sqrt(), p99: numbers[numbers.len() * 99 / 100] }
}

impl fmt::Display for Spread {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{:.2} / {:.2}", self.rms, self.p99)
    }
}
