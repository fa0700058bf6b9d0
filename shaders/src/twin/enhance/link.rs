//! How each enhancer packs its constants: as its WGSL module says.

use glam::DVec3;
use optics::{BandPicker, ClipPlane, Enhancer, LayerOpacity, Probe, Trapezoid};

/// The four vectors of a link.
pub type Constants<F> = [[F; 4]; 4];

/// The constants of an enhancer.
pub fn constants(enhancer: &Enhancer) -> Constants<f64> {
    match enhancer {
        Enhancer::ClipPlane(plane) => clip_plane(plane),
        Enhancer::Probe(probe) => of_probe(probe),
        Enhancer::BandPicker(picker) => band_picker(picker),
        Enhancer::LayerOpacity(layer) => layer_opacity(layer),
    }
}

const UNUSED: [f64; 4] = [0.0; 4];

fn with(v: DVec3, w: f64) -> [f64; 4] {
    [v.x, v.y, v.z, w]
}

/// Corners that f32 can distinguish from each other's flanks: a flank that begins a million domains away is level.
fn corners(band: &Trapezoid) -> [f64; 4] {
    band.corners().map(|corner| corner.clamp(-1e6, 1e6))
}

fn clip_plane(plane: &ClipPlane) -> Constants<f64> {
    let offset = plane.normal_in_display.dot(plane.point_in_display);
    [
        with(plane.normal_in_display, offset),
        [plane.context.low, plane.context.high, plane.thickness_m, plane.boost],
        [plane.strength, 0.0, 0.0, 0.0],
        UNUSED,
    ]
}

fn of_probe(probe: &Probe) -> Constants<f64> {
    [
        with(probe.centre_in_display, probe.radius_m),
        with(probe.axis_in_display, probe.strength),
        [probe.facing.low, probe.facing.high, probe.gradient_most, 0.0],
        [probe.edges.low, probe.edges.high, 0.0, 0.0],
    ]
}

fn band_picker(picker: &BandPicker) -> Constants<f64> {
    [
        corners(&picker.band),
        with(picker.axis_in_display, picker.strength),
        [picker.facing.low, picker.facing.high, 0.0, 0.0],
        UNUSED,
    ]
}

fn layer_opacity(layer: &LayerOpacity) -> Constants<f64> {
    [
        corners(&layer.band),
        with(layer.axis_in_display, 0.0),
        [layer.facing.low, layer.facing.high, layer.away, layer.toward],
        UNUSED,
    ]
}
