//! A volume given by a formula, quantised brick by brick as a store would.

use bricks::store::CodeBits;
use bricks::{
    BRICK_EDGE, BRICK_VOXELS, Brick, BrickError, BrickSource, Codes, Deviation, NodeKey, NodeSummary,
    OVERLAP, OWN_EDGE, OctreeShape,
};
use glam::{DVec3, UVec3};

/// `value` takes the position in units of the finest voxel; samples of coarser levels are point samples.
pub struct ClosureVolume<V> {
    shape: OctreeShape,
    range: (f64, f64),
    bits: CodeBits,
    has_deviation: bool,
    value: V,
}

impl<V: Fn(DVec3) -> f64 + Send + Sync> ClosureVolume<V> {
    /// A volume of `dims` voxels whose values stay within `range`.
    pub fn new(dims: UVec3, range: (f64, f64), value: V) -> Self {
        Self { shape: OctreeShape::new(dims), range, bits: CodeBits::Sixteen, has_deviation: false, value }
    }

    /// The same with so many bits per voxel.
    pub fn with_bits(self, bits: CodeBits) -> Self {
        Self { bits, ..self }
    }

    /// The same, with standard deviations of coarse voxels or without: those of eight points within each.
    pub fn with_deviation(self, has_deviation: bool) -> Self {
        Self { has_deviation, ..self }
    }

    /// The standard deviation about a coarse voxel's own value, of eight points halfway to its corners.
    fn deviation(&self, centre: DVec3, edge: f64) -> f64 {
        let (low, high) = self.range;
        let at = |point: DVec3| (self.value)(point).clamp(low, high);
        let middle = at(centre);
        let corner = |i: u32| UVec3::new(i & 1, i >> 1 & 1, i >> 2).as_dvec3() - 0.5;
        let square = |i: u32| (at(centre + 0.5 * edge * corner(i)) - middle).powi(2);
        ((0..8).map(square).sum::<f64>() / 8.0).sqrt()
    }
}

/// Codes of a brick's standard deviations.
fn coded(deviations: &[f64]) -> Deviation {
    let most = deviations.iter().copied().fold(0.0, f64::max);
    let step = (most / 255.0) as f32;
    let code = |&deviation: &f64| {
        if step > 0.0 { (deviation / f64::from(step)).round().min(255.0) as u8 } else { 0 }
    };
    Deviation { codes: deviations.iter().map(code).collect(), step }
}

impl<V: Fn(DVec3) -> f64 + Send + Sync> BrickSource for ClosureVolume<V> {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn has_deviation(&self) -> bool {
        self.has_deviation
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
        let centre = |i: usize| {
            let offset = UVec3::from(
                [i, i / BRICK_EDGE, i / BRICK_EDGE / BRICK_EDGE].map(|n| (n % BRICK_EDGE) as u32),
            );
            let voxel = (first + offset.as_ivec3()).clamp(glam::IVec3::ZERO, last);
            (voxel.as_dvec3() + 0.5) * edge
        };
        let codes = (0..BRICK_VOXELS).map(|i| {
            let value = (self.value)(centre(i));
            ((value.clamp(low, high) - low) / (high - low) * largest).round() as u16
        });
        let codes = match self.bits {
            CodeBits::Eight => Codes::U8(codes.map(|code| code as u8).collect()),
            CodeBits::Sixteen => Codes::U16(codes.collect()),
        };
        let spreads = self.has_deviation && edge > 1.0;
        let deviation = spreads.then(|| {
            let deviations: Vec<f64> = (0..BRICK_VOXELS).map(|i| self.deviation(centre(i), edge)).collect();
            coded(&deviations)
        });
        Ok(Brick { deviation, ..Brick::new(codes, low as f32, ((high - low) / largest) as f32) })
    }
}

/// Smooth bumps between 0.1 and 0.9, a few voxels wide.
pub fn bumps(p: DVec3) -> f64 {
    0.5 + 0.4 * (0.35 * p.x).sin() * (0.3 * p.y + 0.5).cos() * (0.25 * p.z + 1.0).sin()
}
