//! What an eye sees: which projectors' images reach it from a screen point.

use crate::beams::{Beam, Beams, COINCIDENT, bracket};
use crate::zone::zone_of;
use crate::{Display, RayError};
use glam::{DVec2, DVec3};

/// A display as one eye sees it, prepared for many screen points.
#[derive(Clone, Debug)]
pub struct EyeModel {
    beams: Beams,
    eye_in_display: DVec3,
    angular_accuracy: f64,
    /// Metres.
    screen_size: DVec2,
}

impl EyeModel {
    /// The model for an eye, metres in the display frame.
    ///
    /// # Errors
    /// An eye in the screen plane or behind it, or with a non-finite coordinate.
    pub fn new(display: &Display, eye_in_display: DVec3) -> Result<Self, RayError> {
        if !eye_in_display.is_finite() {
            return Err(RayError::NotFinite);
        }
        if eye_in_display.z <= 0.0 {
            return Err(RayError::EyeBehindScreen { z_m: eye_in_display.z });
        }
        Ok(Self {
            beams: Beams::new(display),
            eye_in_display,
            angular_accuracy: display.angular_accuracy,
            screen_size: DVec2::new(display.width_m, display.height_m),
        })
    }

    /// The projectors whose images the eye sees at a screen point, as (index, weight), by rising index. The weights
    /// sum to 1; where no beam reaches the eye there are none.
    ///
    /// Each beam's lobe is a hat over the angle between its horizontal direction and the eye's. Toward a neighbour
    /// its half-base is Φ or the spacing to it, whichever is larger. So where beams are farther apart than Φ, the eye
    /// interpolates linearly between two of them, whether or not they are evenly spaced; and weights are continuous.
    pub fn weights(&self, screen: DVec2) -> Vec<(usize, f64)> {
        let eye_slope = (self.eye_in_display.x - screen.x) / self.eye_in_display.z;
        let direction = eye_slope.atan();
        let beams = self.beams.all_at(screen);
        let lit = |beam: &Beam| self.beams.lights(beam, screen);
        let lobe =
            Lobe { direction, accuracy: self.angular_accuracy, neighbours: bracket(&beams, direction, lit) };
        let (low, high) = lobe.reach();
        let first = beams.partition_point(|beam| beam.slope.atan() <= low);
        let near = beams[first..].iter().take_while(|beam| beam.slope.atan() < high).filter(|beam| lit(beam));
        let mut weights: Vec<(usize, f64)> = near
            .map(|beam| (beam.projector, lobe.weight(beam.slope.atan())))
            .filter(|&(_, w)| w > 0.0)
            .collect();
        normalise(&mut weights);
        weights
    }

    /// A sentence for people that says so, if the eye is outside the viewing zone.
    pub fn outside_zone(&self) -> Option<String> {
        let DVec3 { x, z, .. } = self.eye_in_display;
        match zone_of(self.screen_size, &self.beams, z) {
            Some((low, high)) if (low..=high).contains(&x) => None,
            Some((low, high)) => Some(format!(
                "The eye at x = {x:.2} m is outside the viewing zone, which reaches from {low:.2} to {high:.2} m at \
                 {z:.2} m from the screen: part of the screen stays dark for it."
            )),
            None => Some(format!(
                "At {z:.2} m from the screen there is no viewing zone: part of the screen stays dark for an eye there, \
                 wherever it stands."
            )),
        }
    }
}

/// How much a beam counts for an eye in a direction. Angles in radians.
struct Lobe {
    direction: f64,
    accuracy: f64,
    /// The directions of the beams on both sides of the eye's (or the two nearest on one side).
    neighbours: Option<(f64, f64)>,
}

impl Lobe {
    /// The directions beyond which no beam counts.
    fn reach(&self) -> (f64, f64) {
        let widest = self.neighbours.map_or(self.accuracy, |(low, high)| self.accuracy.max(high - low));
        (self.direction - widest, self.direction + widest)
    }

    fn weight(&self, beam: f64) -> f64 {
        1.0 - (beam - self.direction).abs() / self.half_base(beam)
    }

    /// Toward the eye. Only the two beams next to the eye can have the eye in the gap to their neighbour; one farther
    /// off has a beam between itself and the eye, so of its lobe only the part that Φ gives can reach the eye.
    fn half_base(&self, beam: f64) -> f64 {
        match self.neighbours {
            Some((low, high)) if beam >= low - COINCIDENT && beam <= high + COINCIDENT => {
                self.accuracy.max(high - low)
            }
            _ => self.accuracy,
        }
    }
}

fn normalise(weights: &mut [(usize, f64)]) {
    let sum: f64 = weights.iter().map(|&(_, weight)| weight).sum();
    for (_, weight) in weights.iter_mut() {
        *weight /= sum;
    }
    weights.sort_unstable_by_key(|&(projector, _)| projector);
}

#[cfg(test)]
#[path = "eye_tests.rs"]
mod tests;
