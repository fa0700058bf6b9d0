//! The numbers of a scene that all projectors share, as [`SceneBlock`] holds them for a kernel.

use super::{Real, vector::Vec3};
use layout::{Link, SceneBlock, brick};
use needs::tables::TABLE_CELLS;
use optics::MOST_ENHANCERS;

/// See [`SceneBlock`]; one field for each number that the twin needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneNumbers<F> {
    /// Columns of the display-to-volume affine map, translation last; voxels per metre.
    pub volume_from_display: [Vec3<F>; 4],
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
    /// c0 and c1 of the wanted level above the finest, log2(c0 + c1 |z|).
    pub resolution: [F; 2],
    /// Strength of the shading of detail.
    pub detail: F,
    /// The volume's diagonal, metres.
    pub diagonal_m: F,
    /// The constants of the chain's links.
    pub links: [Constants<F>; MOST_ENHANCERS],
}

/// The four vectors of constants of a link of a chain.
pub type Constants<F> = [[F; 4]; 4];

impl SceneNumbers<f64> {
    /// The same numbers as those of a twin: in f32 as a kernel reads them.
    pub fn rounded<F: Real>(&self) -> SceneNumbers<F> {
        let vector = Vec3::rounded;
        SceneNumbers {
            volume_from_display: self.volume_from_display.map(vector),
            dims: vector(self.dims),
            voxel_m: F::of(self.voxel_m),
            toward_light: vector(self.toward_light),
            gradient_half_square: F::of(self.gradient_half_square),
            material: self.material.map(F::of),
            step_voxels: F::of(self.step_voxels),
            termination: F::of(self.termination),
            tolerance: F::of(self.tolerance),
            extinction_per_metre: F::of(self.extinction_per_metre),
            gamma: F::of(self.gamma),
            largest_importance: F::of(self.largest_importance),
            finest_depth: self.finest_depth,
            resolution: self.resolution.map(F::of),
            detail: F::of(self.detail),
            diagonal_m: F::of(self.diagonal_m),
            links: self.links.map(|link| link.map(|vector| vector.map(F::of))),
        }
    }
}

impl SceneNumbers<f32> {
    /// The uniform block of this scene over an atlas of so many slots along x, y, z.
    pub fn block(&self, atlas_slots: [u32; 3]) -> SceneBlock {
        let column = |v: Vec3<f32>| [v.0[0], v.0[1], v.0[2], 0.0];
        let with = |v: Vec3<f32>, w: f32| [v.0[0], v.0[1], v.0[2], w];
        let texels = atlas_slots.map(|n| 1.0 / (n * brick::EDGE as u32) as f32);
        SceneBlock {
            volume_from_display: self.volume_from_display.map(column),
            volume: with(self.dims, self.voxel_m),
            light: with(self.toward_light, self.gradient_half_square),
            material: self.material,
            quality: [self.step_voxels, self.termination, self.extinction_per_metre, self.tolerance],
            mimda: [self.gamma, self.largest_importance, 0.0, 0.0],
            texel: [texels[0], texels[1], texels[2], 0.0],
            atlas: [atlas_slots[0], atlas_slots[1], atlas_slots[2], self.finest_depth],
            tables: [TABLE_CELLS as u32, 0, 0, 0],
            resolution: [self.resolution[0], self.resolution[1], self.detail, self.diagonal_m],
        }
    }

    /// The chain's constants, as kernels with enhancers read them.
    pub fn links(&self) -> [Link; MOST_ENHANCERS] {
        self.links.map(|[a, b, c, d]| Link { a, b, c, d })
    }
}
