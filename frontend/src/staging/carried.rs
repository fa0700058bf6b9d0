//! What tools carry.

use super::Piece;
use crate::scene::{HeldLight, HeldTool, fade, usual_enhancer};
use optics::{Enhancer, EnhancerKind, MOST_ENHANCERS};
use world::{ShownTool, Stage, ToolKind};

/// The enhancer that tools of a kind carry.
fn enhancer_kind(kind: ToolKind) -> Option<EnhancerKind> {
    match kind {
        ToolKind::Pointer | ToolKind::Light => None,
        ToolKind::ClipPlane => Some(EnhancerKind::ClipPlane),
        ToolKind::Probe => Some(EnhancerKind::Probe),
        ToolKind::BandPicker => Some(EnhancerKind::BandPicker),
        ToolKind::LayerOpacity => Some(EnhancerKind::LayerOpacity),
    }
}

/// Whether tools of a kind carry an enhancer.
pub fn carries(kind: ToolKind) -> bool {
    enhancer_kind(kind).is_some()
}

/// Whether that looks at a band of values.
pub fn needs_band(kind: ToolKind) -> bool {
    enhancer_kind(kind).is_some_and(EnhancerKind::needs_band)
}

/// A tool as scenes know them.
pub(super) fn held(tool: &ShownTool) -> HeldTool {
    HeldTool { tip_m: tool.tip_m, rotation: tool.rotation, presence: tool.presence }
}

/// What the tools of a stage carry, in their places: in the order of the kinds, so that what brings out a layer comes before what
/// looks at importance, and within a kind in the order of the tools. There is room for `room` of them; who makes a cast sees to
/// it that there are not more.
pub(super) fn carried(stage: &Stage, piece: &Piece, room: usize) -> Vec<Enhancer> {
    let mut links: Vec<(EnhancerKind, Enhancer)> = Vec::new();
    for tool in &stage.tools {
        let Some(kind) = enhancer_kind(tool.kind) else { continue };
        let band = piece.band(stage.band);
        let Some(mut enhancer) = piece.template(kind).or_else(|| usual_enhancer(kind, band)) else {
            continue;
        };
        if let (Some(own), Some(band)) = (enhancer.band_mut(), stage.band.and(band)) {
            *own = band;
        }
        enhancer.place(tool.tip_m, Some(held(tool).axis()));
        fade(&mut enhancer, tool.presence);
        links.push((kind, enhancer));
    }
    links.sort_by_key(|(kind, _)| match kind {
        EnhancerKind::ClipPlane => 0,
        EnhancerKind::BandPicker => 1,
        EnhancerKind::LayerOpacity => 2,
        EnhancerKind::Probe => 3,
    });
    links.into_iter().map(|(_, enhancer)| enhancer).take(room.min(MOST_ENHANCERS)).collect()
}

/// Where the first of the tools that are lights has the light come from.
pub(super) fn light(stage: &Stage) -> Option<HeldLight> {
    let tool = stage.tools.iter().find(|tool| tool.kind == ToolKind::Light)?;
    Some(HeldLight { toward: -held(tool).axis(), presence: tool.presence })
}
