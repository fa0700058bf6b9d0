//! How far a registration may be off where people are.

use display_config::Display;
use glam::DVec3;
use serde::Serialize;
use tracking::Registration;

/// The expected error at a place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExpectedError {
    /// What people call the place.
    pub place: &'static str,
    /// Where it is in the display's frame, metres.
    pub point_m: DVec3,
    /// Expected error there, RMS, metres.
    pub error_m: f64,
}

/// At the screen's centre, and with a display at both edges of its viewing zone, as far from the screen as its observer.
pub(super) fn expected_errors(found: &Registration, display: Option<&Display>) -> Vec<ExpectedError> {
    let mut places = vec![("the screen's centre", DVec3::ZERO)];
    if let Some(display) = display {
        let observer = display.observer_in_display;
        let edges = display.viewing_zone(observer.z).into_iter().flat_map(|(low, high)| [low, high]);
        let names = ["the viewing zone's left edge", "the viewing zone's right edge"];
        places.extend(names.into_iter().zip(edges.map(|x| observer.with_x(x))));
    }
    let expected = |(place, point_m)| ExpectedError { place, point_m, error_m: found.error_at_m(point_m) };
    places.into_iter().map(expected).collect()
}
