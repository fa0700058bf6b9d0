//! The beams that cross the screen at a point.

use crate::{Display, Projector, RasterInverse};
use glam::DVec2;

/// Beams closer than this in angle, radians, count as one direction lit twice.
pub(crate) const COINCIDENT: f64 = 1e-9;

/// The projectors of a display as sources of beams, prepared for many screen points.
#[derive(Clone, Debug)]
pub(crate) struct Beams {
    /// In the order of their beams at the screen's centre, so that sorting them elsewhere finds them nearly sorted.
    sources: Vec<Source>,
}

/// A projector as a source of beams.
#[derive(Clone, Copy, Debug)]
struct Source {
    projector: usize,
    centre_x: f64,
    /// −Ez, metres.
    throw_m: f64,
    pixels: RasterInverse,
}

impl Source {
    fn of((projector, entry): (usize, &Projector)) -> Option<Self> {
        let centre = entry.centre_in_display;
        Some(Self { projector, centre_x: centre.x, throw_m: -centre.z, pixels: entry.raster.inverse()? })
    }

    fn slope_at(&self, screen_x: f64) -> f64 {
        (screen_x - self.centre_x) / self.throw_m
    }
}

/// One beam through a screen point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Beam {
    /// The index of its projector.
    pub projector: usize,
    /// dx/dz: the tangent of its horizontal direction.
    pub slope: f64,
    source: usize,
}

impl Beams {
    pub fn new(display: &Display) -> Self {
        let mut sources: Vec<Source> = display.projectors.iter().enumerate().filter_map(Source::of).collect();
        sources.sort_by(|a, b| a.slope_at(0.0).total_cmp(&b.slope_at(0.0)));
        Self { sources }
    }

    /// The beam of each projector at a screen point, covered by its raster or not, by rising slope.
    pub fn all_at(&self, screen: DVec2) -> Vec<Beam> {
        let beam = |(source, from): (usize, &Source)| Beam {
            projector: from.projector,
            slope: from.slope_at(screen.x),
            source,
        };
        let mut beams: Vec<Beam> = self.sources.iter().enumerate().map(beam).collect();
        beams.sort_by(|a, b| a.slope.total_cmp(&b.slope));
        beams
    }

    /// Whether a beam's projector lights the screen point at all.
    pub fn lights(&self, beam: &Beam, screen: DVec2) -> bool {
        self.sources[beam.source].pixels.covers(screen)
    }

    /// The smallest and the largest slope of the beams that light a screen point.
    pub fn fan_at(&self, screen: DVec2) -> Option<(f64, f64)> {
        let slopes = self.sources.iter().filter(|s| s.pixels.covers(screen)).map(|s| s.slope_at(screen.x));
        slopes.fold(None, |fan, slope| {
            let (low, high) = fan.unwrap_or((slope, slope));
            Some((slope.min(low), slope.max(high)))
        })
    }
}

/// The directions, radians, of the lit beams next to a direction: at or below it, and above it. Where the direction
/// lies outside the fan, the two outermost beams on that side. None with fewer than two directions.
pub(crate) fn bracket(beams: &[Beam], direction: f64, lit: impl Fn(&Beam) -> bool) -> Option<(f64, f64)> {
    let slope = direction.tan();
    let split = beams.partition_point(|beam| beam.slope <= slope);
    let mut below = beams[..split].iter().rev().filter(|b| lit(b)).map(|b| b.slope.atan());
    let mut above = beams[split..].iter().filter(|b| lit(b)).map(|b| b.slope.atan());
    match (below.next(), above.next()) {
        (Some(low), Some(high)) if high - low > COINCIDENT => Some((low, high)),
        (Some(low), Some(high)) => above
            .find(|&next| next - low > COINCIDENT)
            .map(|next| (low, next))
            .or_else(|| below.find(|&next| high - next > COINCIDENT).map(|next| (next, high))),
        (Some(last), None) => below.find(|&next| last - next > COINCIDENT).map(|next| (next, last)),
        (None, Some(first)) => above.find(|&next| next - first > COINCIDENT).map(|next| (first, next)),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The angle, radians, between the two beams of a display that enclose a direction at a screen point.
    fn spacing_at(display: &Display, screen: DVec2, direction: f64) -> Option<f64> {
        let sources = Beams::new(display);
        bracket(&sources.all_at(screen), direction, |beam| sources.lights(beam, screen))
            .map(|(low, high)| high - low)
    }

    #[test]
    fn holo72_has_beams_every_0_97_degrees() {
        let display = Display::load("holo72").unwrap();
        let spacing = spacing_at(&display, DVec2::ZERO, 0.0).unwrap();
        assert!((spacing.to_degrees() - 0.968).abs() < 1e-3, "{}", spacing.to_degrees());
        // The same spacing in x is a smaller angle off the axis: cos² of the direction.
        let aside = spacing_at(&display, DVec2::ZERO, 0.5).unwrap();
        assert!((aside / spacing - 0.5f64.cos().powi(2)).abs() < 0.01);
    }

    #[test]
    fn outside_the_fan_the_outermost_pair_counts() {
        let display = Display::load("desk8").unwrap();
        let outermost = spacing_at(&display, DVec2::ZERO, 0.56f64.atan() - 1e-3).unwrap();
        assert_eq!(spacing_at(&display, DVec2::ZERO, 1.5), Some(outermost));
    }

    #[test]
    fn one_direction_has_no_spacing() {
        let mut display = Display::load("desk8").unwrap();
        display.projectors.truncate(1);
        assert_eq!(spacing_at(&display, DVec2::ZERO, 0.0), None);
        let mut twin = display.projectors[0].clone();
        twin.name = "twin".into();
        display.projectors.push(twin);
        assert_eq!(spacing_at(&display, DVec2::ZERO, 0.0), None);
    }
}
