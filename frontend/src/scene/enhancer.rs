//! An enhancer of a scene, before a frame gives it its place.

use super::band::normalised_band;
use glam::DVec3;
use optics::{Enhancer, Trapezoid, TrapezoidError};
use protocol::Tool;

/// What an enhancer goes with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anchor {
    /// The volume's centre in each frame.
    Volume,
    /// A fixed point of the display frame, metres.
    Point(DVec3),
    /// The tool: its tip, and the direction in which it points.
    Tool,
}

/// One link of a scene's chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneEnhancer {
    /// Its numbers: bands over data values, and a place that its anchor may change.
    pub numbers: Enhancer,
    /// What it goes with.
    pub anchor: Anchor,
}

impl SceneEnhancer {
    /// Where it is in a frame, bands still over data values. A band-picker picks `picked` if there is one.
    pub(super) fn placed(
        &self,
        volume_centre: DVec3,
        tool: Option<&Tool>,
        picked: Option<Trapezoid>,
    ) -> Enhancer {
        let carrier = tool.filter(|_| self.anchor == Anchor::Tool);
        let place = match (self.anchor, carrier) {
            (_, Some(tool)) => tool.tip_in_display,
            (Anchor::Point(point), None) => point,
            (Anchor::Volume | Anchor::Tool, None) => volume_centre,
        };
        let axis = carrier.map(|tool| tool.axis_in_display);
        let mut numbers = self.numbers;
        match &mut numbers {
            Enhancer::ClipPlane(plane) => {
                plane.point_in_display = place;
                plane.normal_in_display = axis.map_or(plane.normal_in_display, |axis| -axis);
            }
            Enhancer::Probe(probe) => {
                probe.centre_in_display = place;
                probe.axis_in_display = axis.unwrap_or(probe.axis_in_display);
            }
            Enhancer::BandPicker(picker) => {
                picker.axis_in_display = axis.unwrap_or(picker.axis_in_display);
                picker.band = picked.unwrap_or(picker.band);
            }
            Enhancer::LayerOpacity(layer) => {
                layer.axis_in_display = axis.unwrap_or(layer.axis_in_display);
            }
        }
        numbers
    }
}

/// The band of an enhancer that has one.
pub(super) fn band_of(enhancer: &Enhancer) -> Option<Trapezoid> {
    match enhancer {
        Enhancer::BandPicker(picker) => Some(picker.band),
        Enhancer::LayerOpacity(layer) => Some(layer.band),
        Enhancer::ClipPlane(_) | Enhancer::Probe(_) => None,
    }
}

/// An enhancer with its band over data values as one with its band over s.
pub(super) fn normalised_enhancer(
    mut enhancer: Enhancer,
    domain: (f64, f64),
) -> Result<Enhancer, TrapezoidError> {
    match &mut enhancer {
        Enhancer::BandPicker(picker) => picker.band = normalised_band(picker.band, domain)?,
        Enhancer::LayerOpacity(layer) => layer.band = normalised_band(layer.band, domain)?,
        Enhancer::ClipPlane(_) | Enhancer::Probe(_) => {}
    }
    Ok(enhancer)
}
