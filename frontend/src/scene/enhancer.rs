//! An enhancer of a scene, before a frame gives it its place.

use super::Tool;
use super::band::normalised_band;
use glam::DVec3;
use optics::{Enhancer, Trapezoid, TrapezoidError};

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
    /// Where it is in a frame, bands still over data values. What a tool carries acts by as much of it as is there, from 0 to
    /// 1. A band-picker picks `picked` if there is one.
    pub(super) fn placed(
        &self,
        volume_centre: DVec3,
        tool: Option<&Tool>,
        presence: f64,
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
        numbers.place(place, axis);
        if carrier.is_some() {
            fade(&mut numbers, presence);
        }
        if let (Enhancer::BandPicker(picker), Some(picked)) = (&mut numbers, picked) {
            picker.band = picked;
        }
        numbers
    }
}

/// Takes an enhancer back to a share of what it does.
pub fn fade(enhancer: &mut Enhancer, share: f64) {
    match enhancer {
        Enhancer::ClipPlane(plane) => plane.strength *= share,
        Enhancer::Probe(probe) => probe.strength *= share,
        Enhancer::BandPicker(picker) => picker.strength *= share,
        Enhancer::LayerOpacity(layer) => {
            let faded = |factor: f64| 1.0 + share * (factor - 1.0);
            (layer.away, layer.toward) = (faded(layer.away), faded(layer.toward));
        }
    }
}

/// An enhancer with its band over data values as one with its band over s.
pub(super) fn normalised_enhancer(
    mut enhancer: Enhancer,
    domain: (f64, f64),
) -> Result<Enhancer, TrapezoidError> {
    if let Some(band) = enhancer.band_mut() {
        *band = normalised_band(*band, domain)?;
    }
    Ok(enhancer)
}
