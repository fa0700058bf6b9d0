//! From point pairs to the rigid transform between a tracker's frame and the display's.
//!
//! | file | what it is |
//! | --- | --- |
//! | `pair` | a mark, seen from both frames |
//! | `check` | whether points can be registered at all |
//! | `fit` | the transform by least squares |
//! | `units` | whether both frames are in metres |
//! | `outliers` | pairs that do not fit to the others |
//! | `spread`, `eigen` | principal axes, and the eigenvectors that they and the fit are |

mod check;
mod eigen;
mod error;
mod fit;
mod outliers;
mod pair;
mod spread;
mod units;

pub use error::{Frame, Outlier, RegistrationError};
pub use pair::PointPair;

use crate::rigid::RigidTransform;
use fit::Fit;
use glam::DVec3;

/// One fit is clearly better than another if it leaves so many times less.
const CLEARLY: f64 = 2.0;
/// Residuals below this are the same for that question, metres: what rounding leaves says nothing.
const FINEST_M: f64 = 1e-4;
/// Whatever leaves more than this is no registration, RMS, metres.
const MOST_RMS_M: f64 = 0.05;

/// Whether the tracker's axes are right-handed, as the display's are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handedness {
    /// They are.
    Right,
    /// The points lie in a plane, or nearly, and do not tell: if they are left-handed, what is before the plane will seem
    /// to be behind it.
    Unclear,
}

/// A registration that has been accepted.
#[derive(Clone, Debug, PartialEq)]
pub struct Registration {
    /// The transform.
    pub display_from_tracker: RigidTransform,
    /// How far each pair's points are apart after the transform, metres, in the order of the pairs.
    pub residuals_m: Vec<f64>,
    /// Their root mean square.
    pub rms_m: f64,
    /// The display's lengths over the tracker's; 1 but for errors. The transform does not scale.
    pub scale: f64,
    /// What the points tell of the tracker's axes.
    pub handedness: Handedness,
    fit: Fit,
}

impl Registration {
    /// Expected error of the transform at a point of the display frame, RMS, metres: how far the errors of the pairs move
    /// what is there (Fitzpatrick, West and Maurer 1998). The tracker's own error there comes on top.
    pub fn error_at_m(&self, point_in_display: DVec3) -> f64 {
        self.fit.point_error_m() * self.fit.gain_at(point_in_display)
    }
}

/// Registers pairs by least squares, all with the same weight, without a scale.
///
/// # Errors
/// Pairs that do not fix a transform, that one does not fit, or of which some are wrong.
pub fn register(pairs: &[PointPair]) -> Result<Registration, RegistrationError> {
    check::check(pairs)?;
    let fit = Fit::of(&pairs.iter().collect::<Vec<_>>());
    let (rms_m, mirrored_rms_m) = (fit.rms_m, fit.mirrored_rms_m);
    if is_clearly_better(mirrored_rms_m, rms_m) {
        return Err(RegistrationError::LeftHanded { rms_m, mirrored_rms_m });
    }
    if let Some((outliers, rms_without_m)) = outliers::outliers(pairs) {
        return Err(RegistrationError::Outliers { outliers, rms_without_m });
    }
    let residuals_m: Vec<f64> = pairs.iter().map(|pair| fit.distance_m(pair)).collect();
    let scale = units::best_scale(pairs);
    if rms_m > MOST_RMS_M {
        let worst = residuals_m.iter().zip(pairs).max_by(|a, b| a.0.total_cmp(b.0));
        let worst = worst.map_or(String::new(), |(_, pair)| pair.name.clone());
        return Err(RegistrationError::TooFarApart { rms_m, worst, scale });
    }
    let is_right = is_clearly_better(rms_m, mirrored_rms_m);
    let handedness = if is_right { Handedness::Right } else { Handedness::Unclear };
    let display_from_tracker = fit.display_from_tracker;
    Ok(Registration { display_from_tracker, residuals_m, rms_m, scale, handedness, fit })
}

fn is_clearly_better(rms_m: f64, other_rms_m: f64) -> bool {
    CLEARLY * (rms_m + FINEST_M) < other_rms_m + FINEST_M
}

#[cfg(test)]
mod tests;
