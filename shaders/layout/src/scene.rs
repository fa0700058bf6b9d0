//! What a kernel must know of the scene: the same for all projectors.

use bytemuck::{Pod, Zeroable};

/// The uniform block of a scene. Every member fills 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct SceneBlock {
    /// Columns of the display-to-volume affine map, translation last; voxels per metre.
    pub volume_from_display: [[f32; 4]; 4],
    /// Size of the volume in finest voxels, then the edge of the finest voxel in metres.
    pub volume: [f32; 4],
    /// Toward the light in the display frame, then gradient_half².
    pub light: [f32; 4],
    /// Ambient, diffuse, specular, shininess.
    pub material: [f32; 4],
    /// Longest step in voxels of the node, termination ε, extinction per metre of table value 1, error
    /// allowed per step.
    pub quality: [f32; 4],
    /// γ, largest importance of the transfer function, unused, unused.
    pub mimda: [f32; 4],
    /// 1 / size of the atlas in texels along each axis, unused.
    pub texel: [f32; 4],
    /// Slots of the atlas along x, y, z, then the depth of the finest level.
    pub atlas: [u32; 4],
    /// Cells of the tables, unused, unused, unused.
    pub tables: [u32; 4],
    /// c0 and c1 of the wanted level above the finest, log2(c0 + c1 |z|); strength of the shading of detail; diagonal of
    /// the volume in metres.
    pub resolution: [f32; 4],
}

/// The constants of one link of a chain of enhancers; its module says what they are. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Link {
    /// As the enhancer's module says.
    pub a: [f32; 4],
    /// As the enhancer's module says.
    pub b: [f32; 4],
    /// As the enhancer's module says.
    pub c: [f32; 4],
    /// As the enhancer's module says.
    pub d: [f32; 4],
}
