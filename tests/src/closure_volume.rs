//! A volume given by a formula, quantised brick by brick as a store would.

use bricks::store::CodeBits;
use bricks::{
    BRICK_EDGE, BRICK_VOXELS, Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OVERLAP, OWN_EDGE,
    OctreeShape,
};
use glam::{DVec3, UVec3};

/// `value` takes the position in units of the finest voxel; samples of coarser levels are point samples.
pub struct ClosureVolume<V> {
    shape: OctreeShape,
    range: (f64, f64),
    bits: CodeBits,
    value: V,
}

impl<V: Fn(DVec3) -> f64 + Send + Sync> ClosureVolume<V> {
    /// A volume of `dims` voxels whose values stay within `range`.
    pub fn new(dims: UVec3, range: (f64, f64), value: V) -> Self {
        Self { shape: OctreeShape::new(dims), range, bits: CodeBits::Sixteen, value }
    }

    /// The same with so many bits per voxel.
    pub fn with_bits(self, bits: CodeBits) -> Self {
        Self { bits, ..self }
    }
}

impl<V: Fn(DVec3) -> f64 + Send + Sync> BrickSource for ClosureVolume<V> {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn frame(&self) -> bricks::volume::VolumeFrame {
        bricks::volume::VolumeFrame::of_voxels(DVec3::splat(1e-3))
    }

    fn value_range(&self) -> (f64, f64) {
        self.range
    }

    fn summary(&self, _: NodeKey) -> NodeSummary {
        NodeSummary { min: self.range.0 as f32, max: self.range.1 as f32 }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        let last = self.shape.level_dims(node.depth).as_ivec3() - 1;
        let edge = f64::from(1u32 << self.shape.level(node.depth));
        let first = node.cell.as_ivec3() * OWN_EDGE as i32 - OVERLAP as i32;
        let (low, high) = self.range;
        let largest = f64::from(self.bits.largest());
        let codes = (0..BRICK_VOXELS).map(|i| {
            let offset = UVec3::from(
                [i, i / BRICK_EDGE, i / BRICK_EDGE / BRICK_EDGE].map(|n| (n % BRICK_EDGE) as u32),
            );
            let voxel = (first + offset.as_ivec3()).clamp(glam::IVec3::ZERO, last);
            let value = (self.value)((voxel.as_dvec3() + 0.5) * edge);
            ((value.clamp(low, high) - low) / (high - low) * largest).round() as u16
        });
        let codes = match self.bits {
            CodeBits::Eight => Codes::U8(codes.map(|code| code as u8).collect()),
            CodeBits::Sixteen => Codes::U16(codes.collect()),
        };
        Ok(Brick::new(codes, low as f32, ((high - low) / largest) as f32))
    }
}
