//! A field as a volume of any size: bricks and slabs made on demand.

use super::field::Field;
use super::named::{FIELD_NAMES, field_named};
use crate::store::{CodeBits, quantise};
use crate::volume::{Element, MAX_EDGE_VOXELS, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
use crate::{
    BRICK_EDGE, BRICK_VOXELS, Brick, BrickError, BrickSource, NodeKey, NodeSummary, OVERLAP, OWN_EDGE,
    OctreeShape,
};
use glam::{DVec3, UVec3};
use rayon::prelude::*;

/// Edge in voxels of the blocks for which a field is bounded as a whole.
const BLOCK: usize = 32;

/// Where the field is zero in a layer of blocks.
#[derive(Default)]
struct Zeros {
    layer: Option<u32>,
    blocks: Vec<bool>,
}

/// A procedural volume. Its voxels are point samples of the field at every level: coarse levels are not averages.
pub struct ProceduralVolume {
    info: VolumeInfo,
    shape: OctreeShape,
    field: Box<dyn Field>,
    /// Voxels along the largest axis: one unit of the field.
    unit_voxels: f64,
    zeros: Zeros,
}

impl ProceduralVolume {
    /// The field `name` (one of [`FIELD_NAMES`]) as `dims` cubic voxels of edge `voxel_size_m` metres.
    ///
    /// # Errors
    /// An unknown name, or a size that no volume can have.
    pub fn new(name: &str, dims: UVec3, voxel_size_m: f64) -> Result<Self, VolumeError> {
        let wrong = |what: String| VolumeError::Procedural { name: name.into(), what };
        if dims.min_element() == 0 || dims.max_element() > MAX_EDGE_VOXELS {
            return Err(wrong(format!("of {dims} voxels, each edge must be from 1 to {MAX_EDGE_VOXELS}")));
        }
        if !voxel_size_m.is_finite() || voxel_size_m <= 0.0 {
            return Err(wrong(format!("with voxels of {voxel_size_m} m, the edge must be positive")));
        }
        let unit_voxels = f64::from(dims.max_element());
        let field = field_named(name, dims.as_dvec3() / unit_voxels)
            .ok_or_else(|| wrong(format!("the names are {}", FIELD_NAMES.join(", "))))?;
        let frame = VolumeFrame::of_voxels(DVec3::splat(voxel_size_m));
        let info = VolumeInfo::unscaled(name, dims, frame, Element::F32);
        Ok(Self { info, shape: OctreeShape::new(dims), field, unit_voxels, zeros: Zeros::default() })
    }

    /// The field itself; a position in the volume frame (voxels) is divided by max(dims) first.
    pub fn field(&self) -> &dyn Field {
        self.field.as_ref()
    }

    /// Positions in the field of the 32 stored samples of a node along each axis.
    fn sample_positions(&self, node: NodeKey) -> [[f64; BRICK_EDGE]; 3] {
        let edge = f64::from(1u32 << self.shape.level(node.depth)) / self.unit_voxels;
        let dims = self.shape.level_dims(node.depth);
        [0, 1, 2].map(|axis| {
            let first = i64::from(node.cell[axis]) * OWN_EDGE as i64 - OVERLAP as i64;
            let last = i64::from(dims[axis]) - 1;
            std::array::from_fn(|i| ((first + i as i64).clamp(0, last) as f64 + 0.5) * edge)
        })
    }

    /// A box of the field that holds the stored samples of the node and of all nodes below it: the node's own
    /// overlap reaches farther than that of any node below, 1.5 of its voxels to the last sample's centre.
    fn sample_box(&self, node: NodeKey) -> (DVec3, DVec3) {
        let edge = f64::from(1u32 << self.shape.level(node.depth)) / self.unit_voxels;
        let reach = OVERLAP as f64 - 0.5;
        let low = node.cell.as_dvec3() * OWN_EDGE as f64 - reach;
        let high = low + OWN_EDGE as f64 + 2.0 * reach;
        let end = self.shape.level_dims(node.depth).as_dvec3();
        (low.max(DVec3::ZERO) * edge, high.min(end) * edge)
    }
}

impl BrickSource for ProceduralVolume {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn frame(&self) -> VolumeFrame {
        self.info.frame
    }

    fn value_range(&self) -> (f64, f64) {
        (0.0, 1.0)
    }

    fn summary(&self, node: NodeKey) -> NodeSummary {
        let (low, high) = self.sample_box(node);
        let (min, max) = self.field.range_in_box(low, high);
        NodeSummary { min: min as f32, max: max as f32 }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        if !self.shape.contains(node) {
            return Err(BrickError::damaged(format!(
                "{} has no brick {node:?}: it lies outside",
                self.info.name
            )));
        }
        let mut samples = vec![0.0f32; BRICK_VOXELS];
        if self.summary(node).max > 0.0 {
            let [xs, ys, zs] = self.sample_positions(node);
            let rows = zs.iter().flat_map(|&z| ys.iter().map(move |&y| (y, z)));
            for (row, (y, z)) in samples.chunks_exact_mut(BRICK_EDGE).zip(rows) {
                for (sample, &x) in row.iter_mut().zip(&xs) {
                    *sample = self.field.value(DVec3::new(x, y, z)) as f32;
                }
            }
        }
        Ok(quantise(&samples, CodeBits::Sixteen))
    }
}

impl VolumeReader for ProceduralVolume {
    fn info(&self) -> &VolumeInfo {
        &self.info
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        let Samples::F32(slab) = slab else { panic!("the slab is of the volume's own element") };
        self.look_for_zeros(z);
        let position = |voxel: usize| (voxel as f64 + 0.5) / self.unit_voxels;
        let width = self.info.dims.x as usize;
        let across = width.div_ceil(BLOCK);
        let (field, zeros) = (&self.field, &self.zeros.blocks);
        slab.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            let zeros = &zeros[y / BLOCK * across..][..across];
            for (block, values) in row.chunks_mut(BLOCK).enumerate() {
                if zeros[block] {
                    values.fill(0.0);
                    continue;
                }
                for (i, value) in values.iter_mut().enumerate() {
                    let x = position(block * BLOCK + i);
                    *value = field.value(DVec3::new(x, position(y), position(z as usize))) as f32;
                }
            }
        });
        Ok(())
    }
}

impl ProceduralVolume {
    /// Finds the blocks of slab `z` in which the field is zero, once for all slabs of a layer of blocks.
    fn look_for_zeros(&mut self, z: u32) {
        let layer = z / BLOCK as u32;
        if self.zeros.layer == Some(layer) {
            return;
        }
        let blocks = self.info.dims.map(|n| n.div_ceil(BLOCK as u32));
        let (field, edge) = (&self.field, BLOCK as f64 / self.unit_voxels);
        let is_zero = |block: u32| {
            let low = UVec3::new(block % blocks.x, block / blocks.x, layer).as_dvec3() * edge;
            field.range_in_box(low, low + edge) == (0.0, 0.0)
        };
        self.zeros.blocks = (0..blocks.x * blocks.y).into_par_iter().map(is_zero).collect();
        self.zeros.layer = Some(layer);
    }
}
