//! From a volume in its place to the numbers of a scene.

use super::enhance::constants;
use super::scene::{Constants, SceneNumbers};
use super::vector::Vec3;
use display_config::{Resolution, longest_voxel_edge_m};
use glam::{DAffine3, DMat3, DVec3, UVec3};
use optics::{Detail, Light, MOST_ENHANCERS, Optics, Quality};

/// Where a volume stands in a display.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Volume frame to display frame.
    pub display_from_volume: DAffine3,
    /// Voxels of the volume along each axis.
    pub dims: UVec3,
    /// Depth of the octree's finest level.
    pub finest_depth: u8,
    /// Edge of the finest voxel, metres; of its volume, where edges differ.
    pub voxel_m: f64,
    /// What the display resolves.
    pub resolution: Resolution,
}

/// Strength of the shading of detail, where there is any.
fn detail_strength(light: &Light) -> f64 {
    match light.detail {
        Detail::None => 0.0,
        Detail::Unsharp { strength } => strength,
        Detail::Exaggerated { contrast } => contrast,
    }
}

/// The longest of a box's four diagonals.
fn longest_diagonal(display_from_volume: DMat3, dims: DVec3) -> f64 {
    let signs =
        [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, 1.0), DVec3::new(1.0, 1.0, -1.0)];
    signs.iter().map(|sign| (display_from_volume * (dims * *sign)).length()).fold(0.0, f64::max)
}

/// The constants of the links that do anything, in order.
fn links(optics: &Optics) -> [Constants<f64>; MOST_ENHANCERS] {
    let mut links = optics.enhancers.iter().filter(|e| !e.is_neutral()).map(constants);
    std::array::from_fn(|_| links.next().unwrap_or_default())
}

impl SceneNumbers<f64> {
    /// The numbers of a volume in its place, seen through `optics` in this light at this quality.
    pub fn new(place: Placement, optics: &Optics, light: Option<Light>, quality: &Quality) -> Self {
        let vector = |v: DVec3| Vec3(v.to_array());
        let inverse = place.display_from_volume.inverse();
        let m = inverse.matrix3;
        let light = light.unwrap_or_default();
        let mimda = optics.mimda.as_ref();
        let m3 = place.display_from_volume.matrix3;
        let per_finest = quality.lod_scale / longest_voxel_edge_m(&place.display_from_volume);
        Self {
            volume_from_display: [m.x_axis, m.y_axis, m.z_axis, inverse.translation].map(vector),
            dims: vector(place.dims.as_dvec3()),
            voxel_m: place.voxel_m,
            toward_light: vector(light.toward_light_in_display),
            gradient_half_square: light.gradient_half * light.gradient_half,
            material: [light.ambient, light.diffuse, light.specular, light.shininess],
            step_voxels: quality.step_voxels,
            termination: quality.termination,
            tolerance: quality.tolerance,
            extinction_per_metre: optics.extinction_per_metre(place.voxel_m),
            gamma: mimda.map_or(0.0, |m| m.gamma),
            largest_importance: optics.most_importance_on(0.0, 1.0),
            finest_depth: u32::from(place.finest_depth),
            resolution: [place.resolution.pixel_size_m * per_finest, place.resolution.slope() * per_finest],
            detail: detail_strength(&light),
            diagonal_m: longest_diagonal(m3, place.dims.as_dvec3()),
            links: links(optics),
        }
    }
}
