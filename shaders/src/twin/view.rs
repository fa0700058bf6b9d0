//! The view and the scene's numbers, as [`Params`] holds them for a kernel.

use super::vector::Vec3;
use crate::layout::Params;
use crate::optics::{Light, Optics, Quality};
use crate::tables::{TABLE_ENTRIES, largest_importance};
use display_config::{BeamLaw, Raster};
use glam::{DAffine3, DVec3, UVec3};

/// See [`Params`]; one field for each that the twin needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View<F> {
    /// Columns of the pixel-to-screen homography.
    pub screen_from_pixel: [Vec3<F>; 3],
    /// Columns of the display-to-volume affine map, translation last; voxels per metre.
    pub volume_from_display: [Vec3<F>; 4],
    /// A, B of Ox = A + B Sx, then Oy and Oz.
    pub beam: [F; 4],
    /// Voxels of the volume along each axis.
    pub dims: Vec3<F>,
    /// Edge of the finest voxel, metres.
    pub voxel_m: F,
    /// Toward the light, display frame.
    pub toward_light: Vec3<F>,
    /// Square of the gradient at which shading has half its strength.
    pub gradient_half_square: F,
    /// Ambient, diffuse, specular, shininess.
    pub material: [F; 4],
    /// Longest step, voxels of the node.
    pub step_voxels: F,
    /// Termination ε.
    pub termination: F,
    /// Error allowed per step.
    pub tolerance: F,
    /// Extinction per metre where the table says 1.
    pub extinction_per_metre: F,
    /// γ.
    pub gamma: F,
    /// Largest importance of the transfer function.
    pub largest_importance: F,
    /// Depth of the finest level.
    pub finest_depth: u32,
    /// Width and height of the raster, pixels.
    pub raster: [u32; 2],
}

/// Where a picture is looked at from and what through.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// The projector's pixels.
    pub raster: &'a Raster,
    /// The projector's rays.
    pub law: &'a BeamLaw,
    /// Volume frame to display frame.
    pub display_from_volume: DAffine3,
    /// Voxels of the volume along each axis.
    pub dims: UVec3,
    /// Depth of the octree's finest level.
    pub finest_depth: u8,
}

impl View<f64> {
    /// The view of one projector.
    pub fn new(place: Placement, optics: &Optics, light: Option<Light>, quality: &Quality) -> Self {
        let vector = |v: DVec3| Vec3(v.to_array());
        let inverse = place.display_from_volume.inverse();
        let m = inverse.matrix3;
        let h = place.raster.screen_from_pixel.0;
        let origin = place.law.origin(glam::DVec2::ZERO);
        let voxel_m = place.display_from_volume.matrix3.determinant().abs().cbrt();
        let light = light.unwrap_or_default();
        let mimda = optics.mimda.as_ref();
        Self {
            screen_from_pixel: [vector(h.x_axis), vector(h.y_axis), vector(h.z_axis)],
            volume_from_display: [m.x_axis, m.y_axis, m.z_axis, inverse.translation].map(vector),
            beam: [place.law.a(), place.law.b(), origin.y, origin.z],
            dims: vector(place.dims.as_dvec3()),
            voxel_m,
            toward_light: vector(light.toward_light_in_display),
            gradient_half_square: light.gradient_half * light.gradient_half,
            material: [light.ambient, light.diffuse, light.specular, light.shininess],
            step_voxels: quality.step_voxels,
            termination: quality.termination,
            tolerance: quality.tolerance,
            extinction_per_metre: optics.extinction_per_metre(voxel_m),
            gamma: mimda.map_or(0.0, |m| m.gamma),
            largest_importance: mimda.map_or(0.0, |m| largest_importance(&m.importance)),
            finest_depth: u32::from(place.finest_depth),
            raster: [place.raster.width, place.raster.height],
        }
    }

    /// The same view in f32, as a kernel reads it.
    pub fn rounded(&self) -> View<f32> {
        let vector = |v: Vec3<f64>| Vec3(v.0.map(|x| x as f32));
        View {
            screen_from_pixel: self.screen_from_pixel.map(vector),
            volume_from_display: self.volume_from_display.map(vector),
            beam: self.beam.map(|x| x as f32),
            dims: vector(self.dims),
            voxel_m: self.voxel_m as f32,
            toward_light: vector(self.toward_light),
            gradient_half_square: self.gradient_half_square as f32,
            material: self.material.map(|x| x as f32),
            step_voxels: self.step_voxels as f32,
            termination: self.termination as f32,
            tolerance: self.tolerance as f32,
            extinction_per_metre: self.extinction_per_metre as f32,
            gamma: self.gamma as f32,
            largest_importance: self.largest_importance as f32,
            finest_depth: self.finest_depth,
            raster: self.raster,
        }
    }
}

/// How the tiles of one cast and the atlas lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dispatch {
    /// Slots of the atlas along x, y, z.
    pub atlas_slots: [u32; 3],
    /// Pixels between cast rays: 1 casts them all.
    pub stride: u32,
    /// Tiles along x.
    pub tiles_across: u32,
    /// Tiles to cast.
    pub tiles: u32,
}

impl View<f32> {
    /// The uniform block of one cast.
    pub fn params(&self, dispatch: &Dispatch) -> Params {
        let column = |v: Vec3<f32>| [v.0[0], v.0[1], v.0[2], 0.0];
        let with = |v: Vec3<f32>, w: f32| [v.0[0], v.0[1], v.0[2], w];
        let slots = dispatch.atlas_slots;
        let texels = slots.map(|n| 1.0 / (n * 32) as f32);
        let entries = TABLE_ENTRIES as u32;
        Params {
            screen_from_pixel: self.screen_from_pixel.map(column),
            volume_from_display: self.volume_from_display.map(column),
            beam: self.beam,
            volume: with(self.dims, self.voxel_m),
            light: with(self.toward_light, self.gradient_half_square),
            material: self.material,
            quality: [self.step_voxels, self.termination, self.extinction_per_metre, self.tolerance],
            mimda: [self.gamma, self.largest_importance, 0.0, 0.0],
            texel: [texels[0], texels[1], texels[2], 0.0],
            atlas: [slots[0], slots[1], slots[2], self.finest_depth],
            raster: [self.raster[0], self.raster[1], dispatch.stride, dispatch.tiles_across],
            tables: [entries, entries, dispatch.tiles, 0],
        }
    }
}
