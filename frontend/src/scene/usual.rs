//! The numbers of enhancers for which nothing else is said.

use glam::DVec3;
use optics::{BandPicker, ClipPlane, Enhancer, EnhancerKind, LayerOpacity, Probe, Ramp, Trapezoid};

/// The context of a clip plane: one minus the cosine of the angle to its normal, of 11° and 37°.
pub const CLIP_CONTEXT: Ramp = Ramp { low: 0.02, high: 0.2 };
/// Cosines of the angles to an axis: none of an effect beyond 37°, all of it within 11°.
pub(super) const FACING: Ramp = Ramp { low: 0.8, high: 0.98 };
/// Of the rescaled gradient: homogeneous tissue is not an edge.
pub(super) const EDGES: Ramp = Ramp { low: 0.2, high: 0.8 };
/// The scalar's change over a voxel that counts as the strongest edge, parts of the domain.
pub(super) const GRADIENT_MOST: f64 = 0.1;
/// Metres.
pub(super) const THICKNESS_M: f64 = 0.01;
/// Metres.
pub(super) const RADIUS_M: f64 = 0.1;
pub(super) const AWAY: f64 = 1.0;
pub(super) const TOWARD: f64 = 0.1;

/// One of a kind at the origin, looking into the display; None for a kind that needs a band where there is none.
pub fn usual_enhancer(kind: EnhancerKind, band: Option<Trapezoid>) -> Option<Enhancer> {
    let (facing, axis_in_display, strength) = (FACING, DVec3::NEG_Z, 1.0);
    Some(match kind {
        EnhancerKind::ClipPlane => Enhancer::ClipPlane(ClipPlane {
            point_in_display: DVec3::ZERO,
            normal_in_display: DVec3::Z,
            context: CLIP_CONTEXT,
            thickness_m: THICKNESS_M,
            boost: ClipPlane::OPAQUE,
            strength,
        }),
        EnhancerKind::Probe => Enhancer::Probe(Probe {
            centre_in_display: DVec3::ZERO,
            radius_m: RADIUS_M,
            axis_in_display,
            facing,
            gradient_most: GRADIENT_MOST,
            edges: EDGES,
            strength,
        }),
        EnhancerKind::BandPicker => {
            Enhancer::BandPicker(BandPicker { band: band?, axis_in_display, facing, strength })
        }
        EnhancerKind::LayerOpacity => Enhancer::LayerOpacity(LayerOpacity {
            band: band?,
            axis_in_display,
            facing,
            away: AWAY,
            toward: TOWARD,
        }),
    })
}
