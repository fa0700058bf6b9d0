//! The cut: the leaves that a level-of-detail rule asks for, or that are given.

use super::{Line, corners::Corners};
use bricks::LodRule;
use bricks::is_shown;
use bricks::{
    BRICK_VOXELS, BrickError, BrickSource, Codes, Deviation, NodeKey, OVERLAP, OWN_EDGE, OctreeShape,
};
use glam::{DVec3, IVec3};
use optics::Optics;
use std::collections::{HashMap, HashSet};
use std::sync::{Arc, OnceLock};

/// The voxels of a leaf: codes, with the data value `low + code × step`.
pub struct Voxels {
    /// Quantised samples, x fastest.
    pub codes: Vec<u16>,
    /// Data value of code 0.
    pub low: f64,
    /// Data value per code.
    pub step: f64,
    /// Standard deviations of the source's voxels in each, where the source keeps them.
    pub deviation: Option<Deviation>,
}

/// The samples of a node. Its brick is read when a ray first meets it, and kept.
pub struct Grid {
    key: NodeKey,
    /// Edge of its voxels, finest voxels.
    pub voxel_edge: f64,
    /// Level index of its stored sample (0, 0, 0).
    pub first_sample: IVec3,
    voxels: OnceLock<Result<Voxels, BrickError>>,
}

/// A leaf of the cut.
pub struct Leaf {
    node: u32,
    /// Its region in the volume frame.
    pub region: (DVec3, DVec3),
    /// Bounds of its data values, and of its parent's where those have a share of its samples.
    pub bounds: (f64, f64),
    /// The share, where there is any.
    pub corners: Option<Corners>,
    /// Levels above the finest.
    pub level: u8,
}

enum Branch {
    Leaf(Box<Leaf>),
    /// Where the children's region splits, and the children that hold something.
    Inner(DVec3, [Option<u32>; 8]),
}

struct Node {
    branch: Branch,
    grid: Grid,
    parent: Option<u32>,
}

/// The tree above the leaves.
pub struct Cut {
    source: Arc<dyn BrickSource>,
    shape: OctreeShape,
    nodes: Vec<Node>,
    /// Whether voxels stand for more than their means.
    reads_deviation: bool,
}

impl Cut {
    /// The cut that `rule` asks for: from the root down to the first node that is fine enough.
    pub fn new(source: Arc<dyn BrickSource>, rule: &LodRule) -> Self {
        Self::where_splits(source, |shape, _, key| !rule.is_fine_enough(shape, key))
    }

    /// The same, but a node stays a leaf where the brick of a child that `optics` show cannot be read. All bricks down
    /// to the leaves are read to find that out, and read again when a ray meets them.
    pub fn around_damage(source: Arc<dyn BrickSource>, rule: &LodRule, optics: &Optics) -> Self {
        Self::where_splits(source, |shape, source, key| {
            let is_readable =
                |child: NodeKey| !is_shown(optics, source.summary(child)) || source.brick(child).is_ok();
            let mut children = (0..8).map(|octant| key.child(octant)).filter(|&child| shape.contains(child));
            !rule.is_fine_enough(shape, key) && children.all(is_readable)
        })
    }

    /// The cut with these leaves, and the weights of their corners; see [`super::StoredField::presented`].
    pub fn presented(
        source: Arc<dyn BrickSource>,
        leaves: impl IntoIterator<Item = (NodeKey, [f64; 8])>,
        optics: &Optics,
    ) -> Self {
        let weights: HashMap<NodeKey, [f64; 8]> = leaves.into_iter().collect();
        let above = |&key: &NodeKey| std::iter::successors(key.parent(), |key| key.parent());
        let inner: HashSet<NodeKey> = weights.keys().flat_map(above).collect();
        let mut cut = Self::where_splits(source, |_, _, key| inner.contains(&key));
        for index in 0..cut.nodes.len() {
            if let Some(&weights) = weights.get(&cut.nodes[index].grid.key) {
                cut.blend(index, weights, optics);
            }
        }
        cut
    }

    /// This cut with leaves that blend down to coarser ones that show anything: by the rule of detail they have no weight
    /// at corners that such a leaf touches, and full weight at all others.
    pub fn blended(mut self, rule: &LodRule, optics: &Optics) -> Self {
        for index in 0..self.nodes.len() {
            if matches!(self.nodes[index].branch, Branch::Leaf(_)) {
                let weights = weights_of(&*self.source, rule, optics, self.nodes[index].grid.key);
                self.blend(index, weights, optics);
            }
        }
        self
    }

    /// This cut, with every voxel taken as its mean alone.
    pub fn without_deviation(self) -> Self {
        Self { reads_deviation: false, ..self }
    }

    /// Gives a node's parent its share of the node's samples, where it has one and shows anything.
    fn blend(&mut self, index: usize, weights: [f64; 8], optics: &Optics) {
        let key = self.nodes[index].grid.key;
        let edge = self.voxel_edge(key) * OWN_EDGE as f64;
        let parent = self.nodes[index].parent.map(|parent| self.nodes[parent as usize].grid.key);
        let Some(parent) = parent.map(|key| self.source.summary(key)) else { return };
        if weights == [1.0; 8] || !is_shown(optics, parent) {
            return;
        }
        let Node { branch: Branch::Leaf(leaf), grid, .. } = &mut self.nodes[index] else { return };
        let (low, high) = leaf.bounds;
        if !is_shown(optics, self.source.summary(key)) {
            // The renderer reads no brick of such a node.
            let middle =
                Voxels { codes: vec![0; BRICK_VOXELS], low: 0.5 * (low + high), step: 0.0, deviation: None };
            grid.voxels = OnceLock::from(Ok(middle));
        }
        leaf.bounds = (low.min(f64::from(parent.min)), high.max(f64::from(parent.max)));
        leaf.corners = Some(Corners { low: leaf.region.0, edge, weights });
    }

    fn where_splits(
        source: Arc<dyn BrickSource>,
        splits: impl Fn(&OctreeShape, &dyn BrickSource, NodeKey) -> bool,
    ) -> Self {
        let shape = source.shape();
        let mut cut = Self { source: Arc::clone(&source), shape, nodes: Vec::new(), reads_deviation: true };
        cut.grow(&|key| splits(&shape, source.as_ref(), key), NodeKey::ROOT, None);
        cut
    }

    /// The octree's geometry.
    pub fn shape(&self) -> OctreeShape {
        self.shape
    }

    /// The leaf that `line` is in just after `t`: on a border, the one it is about to enter; along a border, the one
    /// at higher coordinates.
    pub fn leaf_on(&self, line: &Line, t: f64) -> &Leaf {
        self.leaf_where(|axis, coordinate| line.is_beyond(t, axis, coordinate))
    }

    /// The leaf that holds a point; on a border, the one at higher coordinates.
    pub fn leaf_at(&self, point: DVec3) -> &Leaf {
        self.leaf_where(|axis, coordinate| point[axis] >= coordinate)
    }

    /// The samples of a leaf, and those of its ancestors one after the other.
    pub fn ladder(&self, leaf: &Leaf) -> impl Iterator<Item = &Grid> {
        let parent = |&index: &u32| self.nodes[index as usize].parent;
        std::iter::successors(Some(leaf.node), parent).map(|index| &self.nodes[index as usize].grid)
    }

    /// The samples of a leaf.
    pub fn grid(&self, leaf: &Leaf) -> &Grid {
        &self.nodes[leaf.node as usize].grid
    }

    /// A node's voxels.
    pub fn voxels<'a>(&self, grid: &'a Grid) -> Result<&'a Voxels, BrickError> {
        let read = || {
            let voxels = read(self.source.as_ref(), grid.key)?;
            let deviation = voxels.deviation.filter(|_| self.reads_deviation);
            Ok(Voxels { deviation, ..voxels })
        };
        grid.voxels.get_or_init(read).as_ref().map_err(Clone::clone)
    }

    fn leaf_where(&self, is_beyond: impl Fn(usize, f64) -> bool) -> &Leaf {
        let extent = self.shape.dims().as_dvec3();
        let mut index = 0;
        loop {
            match &self.nodes[index].branch {
                Branch::Leaf(leaf) => return leaf,
                Branch::Inner(split, children) => {
                    let octant = (0..3).fold(0, |octant, axis| {
                        let is_upper = split[axis] < extent[axis] && is_beyond(axis, split[axis]);
                        octant | usize::from(is_upper) << axis
                    });
                    let child = children[octant]
                        .expect("a child whose low corner is inside the volume holds some of it");
                    index = child as usize;
                }
            }
        }
    }

    /// Adds a node with all below it; returns its index.
    fn grow(&mut self, splits: &dyn Fn(NodeKey) -> bool, key: NodeKey, parent: Option<u32>) -> u32 {
        let index = self.nodes.len() as u32;
        let branch = Branch::Leaf(Box::new(self.leaf(key, index)));
        self.nodes.push(Node { branch, grid: self.grid_of(key), parent });
        if splits(key) {
            let split = self.shape.region(key).0 + self.voxel_edge(key) * (OWN_EDGE / 2) as f64;
            let mut children = [None; 8];
            for octant in 0..8u32 {
                let child = key.child(octant);
                let exists = self.shape.contains(child);
                children[octant as usize] = exists.then(|| self.grow(splits, child, Some(index)));
            }
            self.nodes[index as usize].branch = Branch::Inner(split, children);
        }
        index
    }

    fn leaf(&self, key: NodeKey, node: u32) -> Leaf {
        let summary = self.source.summary(key);
        Leaf {
            node,
            region: self.shape.region(key),
            bounds: (f64::from(summary.min), f64::from(summary.max)),
            corners: None,
            level: self.shape.level(key.depth),
        }
    }

    fn grid_of(&self, key: NodeKey) -> Grid {
        Grid {
            key,
            voxel_edge: self.voxel_edge(key),
            first_sample: key.cell.as_ivec3() * OWN_EDGE as i32 - OVERLAP as i32,
            voxels: OnceLock::new(),
        }
    }

    fn voxel_edge(&self, key: NodeKey) -> f64 {
        f64::from(1u32 << self.shape.level(key.depth))
    }
}

fn read(source: &dyn BrickSource, key: NodeKey) -> Result<Voxels, BrickError> {
    let brick = source.brick(key)?;
    let codes = match brick.codes {
        Codes::U8(codes) => codes.into_iter().map(u16::from).collect(),
        Codes::U16(codes) => codes,
    };
    if codes.len() != BRICK_VOXELS {
        return Err(BrickError::damaged(format!(
            "brick {key:?} has {} samples instead of {BRICK_VOXELS}",
            codes.len()
        )));
    }
    Ok(Voxels { codes, low: f64::from(brick.low), step: f64::from(brick.step), deviation: brick.deviation })
}

/// The weights of a leaf's corners: 0 where a coarser leaf that shows anything touches.
fn weights_of(source: &dyn BrickSource, rule: &LodRule, optics: &Optics, leaf: NodeKey) -> [f64; 8] {
    let shape = source.shape();
    let is_coarse = |cell: NodeKey| {
        let above = std::iter::successors(cell.parent(), |key| key.parent());
        let coarser = above.filter(|&key| rule.is_fine_enough(&shape, key)).last();
        shape.contains(cell) && coarser.is_some_and(|key| is_shown(optics, source.summary(key)))
    };
    std::array::from_fn(|corner| {
        let cell_at = |i: usize| {
            let offset = [0, 1, 2].map(|axis| (corner >> axis & 1) as i32 + (i >> axis & 1) as i32 - 1);
            let cell = leaf.cell.as_ivec3() + IVec3::from_array(offset);
            (cell.min_element() >= 0).then(|| NodeKey { depth: leaf.depth, cell: cell.as_uvec3() })
        };
        if (0..8).filter_map(cell_at).any(is_coarse) { 0.0 } else { 1.0 }
    })
}
