//! A cut given leaf by leaf, with weights at the leaves' corners: one for the devices, the twin and the reference.

use crate::compare::lod_rule;
use crate::twin_scene::{TwinScene, View, resident};
use bricks::{BRICK_VOXELS, BrickSource, CellRanges, LodRule, NodeKey};
use display_config::Display;
use glam::{IVec3, UVec3};
use layout::{CELL_WORDS, FULL_WEIGHTS, NO_NODE, NO_SLOT, NodeRecord, pack_weights};
use needs::tables::Tables;
use needs::{Compositing, Needs, Way};
use protocol::FrameState;
use reference::StoredField;
use renderer::device::{CastJob, CastOutcome, Device, DevicePicture, Gather, NEVER, Part};
use renderer::working_set::{Cut, IndexRules, build_index, refresh, settle};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use twin::Lattice;

/// A corner of a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Corner {
    /// The leaf's depth.
    pub depth: u8,
    /// Where it lies, in leaves of that depth.
    pub point: UVec3,
    /// Whether a coarser leaf touches it.
    pub touches_coarser: bool,
    /// Whether a finer leaf touches it.
    pub touches_finer: bool,
}

/// A cut over a source.
#[derive(Clone)]
pub struct Presented {
    source: Arc<dyn BrickSource>,
    inner: HashSet<NodeKey>,
    weights: HashMap<NodeKey, [f32; 8]>,
}

impl Presented {
    /// The cut whose inner nodes are those that `splits` names, with the weights that `weight` gives to corners, to 1/255.
    pub fn new(
        source: Arc<dyn BrickSource>,
        splits: impl Fn(NodeKey) -> bool,
        weight: impl Fn(Corner) -> f64,
    ) -> Self {
        let shape = source.shape();
        let (mut inner, mut leaves, mut open) = (HashSet::new(), HashSet::new(), vec![NodeKey::ROOT]);
        while let Some(key) = open.pop() {
            if key.depth < shape.finest_depth() && splits(key) {
                inner.insert(key);
                open.extend((0..8).map(|octant| key.child(octant)).filter(|&child| shape.contains(child)));
            } else {
                leaves.insert(key);
            }
        }
        let code = |corner| ((weight(corner) * 255.0).round() / 255.0) as f32;
        let weights = leaves
            .iter()
            .map(|&key| (key, std::array::from_fn(|i| code(corner_of(&leaves, &inner, key, i as u32)))))
            .collect();
        Self { source, inner, weights }
    }

    /// Its leaves, with the weights of their corners.
    pub fn leaves(&self) -> impl Iterator<Item = (NodeKey, [f64; 8])> {
        self.weights.iter().map(|(&key, weights)| (key, weights.map(f64::from)))
    }

    /// What the reference sees.
    pub fn field(&self, frame: &FrameState) -> StoredField {
        StoredField::presented(Arc::clone(&self.source), self.leaves(), &frame.optics)
    }

    /// What devices and the twin see.
    pub fn scene(&self, display: &Display, frame: &FrameState) -> TwinScene {
        let needs = Needs { blends: true, ..Needs::of(&frame.optics, frame.light.as_ref(), &frame.quality) };
        let tables = Tables::new(&frame.optics, &needs);
        let (shape, lod) = (self.source.shape(), lod_rule(display, frame));
        let is_quadrilinear = frame.quality.quadrilinear;
        let rules = IndexRules { is_quadrilinear, ..IndexRules::new(&shape, &lod, &frame.optics) };
        let (mut cut, mut atlas) = (Cut::new(self.source.summary(NodeKey::ROOT)), Vec::new());
        let mut places = vec![0];
        while let Some(place) = places.pop() {
            let node = *cut.node(place);
            if !rules.is_empty(&node) {
                cut.set_brick(place, resident(&*self.source, node.key, &mut atlas));
            }
            if self.inner.contains(&node.key) {
                let summary = |key| shape.contains(key).then(|| self.source.summary(key));
                let first = cut.split(place, summary);
                places.extend(first..first + 8);
            }
        }
        // All there is shows: the rule asks for the finest level everywhere.
        let finest = LodRule { lod_scale: 0.0, ..lod };
        let order: Vec<u32> = cut.walk().collect();
        refresh(&mut cut, &IndexRules { lod: &finest, ..rules }, &order);
        settle(&mut cut);
        let mut nodes = build_index(&cut, &[], &rules);
        for place in cut.walk() {
            self.blend(&cut, place, frame, &mut nodes, &mut atlas);
        }
        let cells = vec![u32::MAX; atlas.len() / BRICK_VOXELS * CELL_WORDS];
        TwinScene { nodes, atlas, deviations: Vec::new(), tables, cells, needs }
    }

    /// Gives a node its weights, and what goes with them.
    fn blend(
        &self,
        cut: &Cut,
        place: u32,
        frame: &FrameState,
        nodes: &mut [NodeRecord],
        atlas: &mut Vec<u16>,
    ) {
        let node = cut.node(place);
        let weights = self.weights.get(&node.key).map_or(FULL_WEIGHTS, |&weights| pack_weights(weights));
        let parent = node.parent.map(|parent| cut.node(parent)).filter(|parent| parent.brick.is_some());
        let (Some(parent), Some(own)) = (parent.and_then(|parent| parent.summary), node.summary) else {
            return;
        };
        let record = &mut nodes[place as usize];
        record.weights = weights;
        if weights == FULL_WEIGHTS {
            return;
        }
        let optics = &frame.optics;
        let scalar = |value: f32| optics.normalise(f64::from(value));
        if record.slot == NO_SLOT {
            record.slot = (atlas.len() / BRICK_VOXELS) as u32;
            record.offset = (0.5 * (scalar(own.min) + scalar(own.max))) as f32;
            record.scale = 0.0;
            atlas.resize(atlas.len() + BRICK_VOXELS, 0);
        }
        let grows = Compositing::for_optics(optics) == Compositing::Over
            && Way::for_optics(optics) == Way::Straight
            && !frame.quality.quadrilinear;
        if grows {
            let (low, high) = (scalar(own.min.min(parent.min)), scalar(own.max.max(parent.max)));
            let corners = self.source.shape().corners(node.key);
            let corners = corners.map(|corner| frame.display_from_volume.transform_point3(corner));
            record.most_extinction =
                (optics.extinction.max_on(low, high) * optics.most_factor(&corners)) as f32;
        }
    }
}

/// Corner x + 2 y + 4 z of a leaf.
fn corner_of(leaves: &HashSet<NodeKey>, inner: &HashSet<NodeKey>, key: NodeKey, corner: u32) -> Corner {
    let offset = UVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
    let point = key.cell + offset;
    let around =
        (0..8u32).map(|i| point.as_ivec3() - IVec3::from([i & 1, i >> 1 & 1, i >> 2].map(|c| c as i32)));
    let inside = |cell: &IVec3| cell.min_element() >= 0 && cell.max_element() < 1 << key.depth;
    let nodes: Vec<NodeKey> =
        around.filter(inside).map(|cell| NodeKey { depth: key.depth, cell: cell.as_uvec3() }).collect();
    let lies_in_leaf = |node: &NodeKey| {
        std::iter::successors(node.parent(), |key| key.parent()).any(|above| leaves.contains(&above))
    };
    Corner {
        depth: key.depth,
        point,
        touches_coarser: nodes.iter().any(lies_in_leaf),
        touches_finer: nodes.iter().any(|node| inner.contains(node)),
    }
}

impl TwinScene {
    /// The visible cells instead of all: of each node's own samples, and of its parent's where it blends.
    pub fn with_visible_cells(mut self) -> Self {
        let ranges: Vec<CellRanges> =
            self.atlas.chunks_exact(BRICK_VOXELS).map(CellRanges::of_samples).collect();
        let scalars = |node: &NodeRecord, [least, most]: [u16; 2]| {
            let scalar =
                |sample: u16| f64::from(node.offset) + f64::from(node.scale) * f64::from(sample) / 65535.0;
            (scalar(least), scalar(most))
        };
        for node in self.nodes.iter().filter(|node| node.slot != NO_SLOT) {
            let parent = self.nodes.get(node.parent as usize).filter(|_| node.parent != NO_NODE);
            let parent = parent.filter(|above| node.weights != FULL_WEIGHTS && above.slot != NO_SLOT);
            let cells = ranges[node.slot as usize].visible(|cell, range| {
                let (mut low, mut high) = scalars(node, range);
                if let Some(above) = parent {
                    // Cell c of octant o begins in the parent's cell (c + 7 o) / 2 + 1/4.
                    let reach = |axis: usize| {
                        let (half, octant) = (cell[axis] / 2, (node.cell[axis] & 1) as usize);
                        half + 3 * octant..=(half + 1 + 4 * octant).min(7)
                    };
                    let cells = reach(2).flat_map(|z| reach(1).map(move |y| (y, z)));
                    for at in cells.flat_map(|(y, z)| reach(0).map(move |x| [x, y, z])) {
                        let (least, most) = scalars(above, ranges[above.slot as usize].around(at));
                        (low, high) = (low.min(least), high.max(most));
                    }
                }
                !self.tables.is_vacant(low, high)
            });
            let start = node.slot as usize * CELL_WORDS;
            self.cells[start..start + CELL_WORDS].copy_from_slice(&cells);
        }
        self
    }

    /// The scene in a device's memory, which must have a slot for each brick.
    pub fn load(&self, device: &mut Device) {
        for (slot, samples) in self.atlas.chunks_exact(BRICK_VOXELS).enumerate() {
            device.write_brick(slot as u32, samples);
        }
        device.write_tables(self.tables.clone());
        device.write_index(&self.nodes, &self.cells);
    }

    /// Slots of its bricks.
    pub fn slots(&self) -> u32 {
        (self.atlas.len() / BRICK_VOXELS) as u32
    }
}

/// Casts every pixel of a view of what was loaded, ray by ray.
pub fn cast(
    device: &mut Device,
    needs: Needs,
    view: &View<f32>,
    gather: Gather,
    counts: bool,
) -> CastOutcome {
    let View { scene, rays } = view;
    let (views, part) = (std::slice::from_ref(rays), Part::Every(Lattice::ALL));
    let job = CastJob {
        scene,
        views,
        first_picture: 0,
        needs,
        sharing: None,
        mends: false,
        part,
        gather,
        counts,
        stop: NEVER,
    };
    device.cast(&job).expect("the device stays")
}

/// Every pixel of a view of what was loaded, and the number of samples taken.
pub fn picture(device: &mut Device, needs: Needs, view: &View<f32>) -> (Vec<f32>, u64) {
    let outcome = cast(device, needs, view, Gather::Own, true);
    (device.picture(DevicePicture::Cast(0)).expect("the device stays").into_owned(), outcome.samples)
}
