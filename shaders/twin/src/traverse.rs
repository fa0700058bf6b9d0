//! Stackless traversal of the octree along neighbour links.

use super::ray::far;
use super::{Casting, Real, ray::Ray, vector::Vec3};
use layout::{NO_NODE, NodeRecord, brick};

/// Own voxels of a node along an edge.
pub const OWN_EDGE: f64 = brick::OWN_EDGE as f64;

/// Where and through which face a ray leaves a node.
#[derive(Clone, Copy, Debug)]
pub struct Exit<F> {
    /// Metres along the ray.
    pub t: F,
    /// 0 = x, 1 = y, 2 = z.
    pub axis: usize,
}

/// Edge of a node's voxel in finest voxels.
#[inline(always)]
pub fn voxel_edge<F: Real>(finest_depth: u32, depth: u32) -> F {
    F::of_u32(1 << (finest_depth - depth))
}

/// The low corner of a node, finest voxels.
#[inline(always)]
pub fn node_low<F: Real>(finest_depth: u32, node: &NodeRecord) -> Vec3<F> {
    let edge = F::of(OWN_EDGE) * voxel_edge::<F>(finest_depth, node.depth);
    Vec3(node.cell.map(|c| F::of_u32(c) * edge))
}

impl<F: Real> Casting<'_, F> {
    /// Where the ray leaves the node.
    #[inline(always)]
    pub fn exit_of(&self, node: &NodeRecord, ray: &Ray<F>) -> Exit<F> {
        let finest = self.scene.finest_depth;
        let edge = F::of(OWN_EDGE) * voxel_edge::<F>(finest, node.depth);
        let low = node_low::<F>(finest, node);
        let mut exit = Exit { t: far(), axis: 0 };
        for axis in 0..3 {
            if !ray.is_parallel(axis) {
                let face = if ray.is_forward(axis) { low.0[axis] + edge } else { low.0[axis] };
                let t = (face - ray.origin_in_volume.0[axis]) * ray.inverse.0[axis];
                if t < exit.t {
                    exit = Exit { t, axis };
                }
            }
        }
        exit
    }

    /// Which child a point belongs to; on a border, the one the ray goes into.
    #[inline(always)]
    fn octant_of(&self, node: &NodeRecord, point: Vec3<F>, ray: &Ray<F>) -> u32 {
        let finest = self.scene.finest_depth;
        let half = F::of(0.5 * OWN_EDGE) * voxel_edge::<F>(finest, node.depth);
        let low = node_low::<F>(finest, node);
        let mut octant = 0;
        for axis in 0..3 {
            let (p, centre) = (point.0[axis], low.0[axis] + half);
            let is_upper = p > centre || (p == centre && ray.is_forward(axis));
            octant |= u32::from(is_upper) << axis;
        }
        octant
    }

    /// The leaf of the cut at a point.
    #[inline(always)]
    pub fn leaf_at(&self, point: Vec3<F>, ray: &Ray<F>) -> u32 {
        let mut at = 0;
        loop {
            let node = &self.volume.nodes[at as usize];
            if node.first_child == NO_NODE {
                return at;
            }
            at = node.first_child + self.octant_of(node, point, ray);
        }
    }

    /// The leaf beyond the face that the ray leaves `node` through, or [`NO_NODE`].
    #[inline(always)]
    pub fn leaf_beyond(&self, node: &NodeRecord, axis: usize, point: Vec3<F>, ray: &Ray<F>) -> u32 {
        let forward = ray.is_forward(axis);
        let mut at = node.neighbours[2 * axis + usize::from(forward)];
        if at == NO_NODE {
            return NO_NODE;
        }
        let mut cell = node.cell;
        cell[axis] = if forward { cell[axis].wrapping_add(1) } else { cell[axis].wrapping_sub(1) };
        loop {
            let next = &self.volume.nodes[at as usize];
            if next.first_child == NO_NODE {
                return at;
            }
            let octant = if next.depth < node.depth {
                let [x, y, z] = cell.map(|c| (c >> (node.depth - next.depth - 1)) & 1);
                x | (y << 1) | (z << 2)
            } else {
                (self.octant_of(next, point, ray) & !(1 << axis)) | (u32::from(!forward) << axis)
            };
            at = next.first_child + octant;
        }
    }
}
