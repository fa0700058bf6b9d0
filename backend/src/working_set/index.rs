//! The spatial index: the cut as rays traverse it.

use super::{Cut, CutNode, LodRule};
use crate::store::{NodeSummary, OctreeShape};
use shaders::compose::{Compositing, Way};
use shaders::layout::{FULL_WEIGHTS, NO_NODE, NO_SLOT, NodeRecord};
use shaders::optics::Optics;

/// What turns a cut into an index for one frame.
#[derive(Clone, Copy, Debug)]
pub struct IndexRules<'a> {
    /// The octree.
    pub shape: &'a OctreeShape,
    /// How fine nodes must be.
    pub lod: &'a LodRule,
    /// Which values are visible, and how they map to the scalar.
    pub optics: &'a Optics,
    /// Whether samples are blended with those of ancestors, whose values lie beyond the node's own bounds.
    pub is_quadrilinear: bool,
}

impl IndexRules<'_> {
    /// Whether a node leaves the picture as it is: outside the volume, or nothing visible in its range.
    pub fn is_empty(&self, node: &CutNode) -> bool {
        node.summary.is_none_or(|summary| !is_shown(self.optics, summary))
    }

    /// Levels that a node is too coarse by; at most 0 where no finer level exists.
    pub fn deficit(&self, node: &CutNode) -> f64 {
        let deficit = self.lod.deficit(self.shape, node.key);
        if node.key.depth == self.shape.finest_depth() { deficit.min(0.0) } else { deficit }
    }

    fn record(&self, node: &CutNode, neighbours: [u32; 6]) -> NodeRecord {
        let (low, high) = self.optics.domain;
        let per_value = 1.0 / (high - low);
        let visible = node.brick.filter(|_| !self.is_empty(node));
        NodeRecord {
            cell: node.key.cell.to_array(),
            depth: u32::from(node.key.depth),
            parent: node.parent.unwrap_or(NO_NODE),
            first_child: node.first_child.unwrap_or(NO_NODE),
            slot: visible.map_or(NO_SLOT, |brick| brick.slot),
            deficit: self.deficit(node) as f32,
            offset: visible.map_or(0.0, |brick| (brick.low - low) * per_value) as f32,
            scale: visible.map_or(0.0, |brick| brick.span * per_value) as f32,
            neighbours,
            most_extinction: self.most_extinction(node) as f32,
            weights: FULL_WEIGHTS,
            padding: 0,
        }
    }

    /// Steps may grow where extinction is low; not where importance or refraction acts, which have no part in
    /// it, nor where ancestors' values are blended in.
    fn most_extinction(&self, node: &CutNode) -> f64 {
        if self.is_quadrilinear {
            return f64::from(f32::MAX);
        }
        match (node.summary, Compositing::for_optics(self.optics), Way::for_optics(self.optics)) {
            (Some(NodeSummary { min, max }), Compositing::Over, Way::Straight) => {
                let [low, high] = [min, max].map(|value| self.optics.normalise(f64::from(value)));
                self.optics.extinction.max_on(low, high) * self.optics.most_factor()
            }
            (_, Compositing::Mimda(_), _) | (_, _, Way::Refracted) | (None, ..) => f64::from(f32::MAX),
        }
    }
}

/// Whether transfer functions show any value between a node's bounds.
pub fn is_shown(optics: &Optics, NodeSummary { min, max }: NodeSummary) -> bool {
    !optics.is_empty_on(f64::from(min), f64::from(max))
}

/// One record per place of the cut, with its neighbour links. A link leads to the node beyond the face at the same
/// depth, or to the coarser leaf there.
pub fn build_index(cut: &Cut, rules: &IndexRules) -> Vec<NodeRecord> {
    let mut records: Vec<NodeRecord> = vec![bytemuck::Zeroable::zeroed(); cut.nodes().len()];
    for place in cut.walk() {
        let node = cut.node(place);
        let neighbours = match node.parent {
            None => [NO_NODE; 6],
            Some(parent) => links(cut, node, parent, records[parent as usize].neighbours, place),
        };
        records[place as usize] = rules.record(node, neighbours);
    }
    records
}

/// The links of a child: to its siblings inside the family; beyond the parent's faces to the children of the parent's
/// neighbour, or to that neighbour where it is a leaf.
fn links(cut: &Cut, node: &CutNode, parent: u32, of_parent: [u32; 6], place: u32) -> [u32; 6] {
    let first = cut.node(parent).first_child.expect("a parent has children");
    let octant = place - first;
    std::array::from_fn(|face| {
        let (bit, upper) = (1u32 << (face / 2), face as u32 % 2);
        let mirrored = octant ^ bit;
        let stays_inside = (octant & bit != 0) == (upper == 0);
        if stays_inside {
            return first + mirrored;
        }
        let beyond = of_parent[face];
        if beyond == NO_NODE {
            return NO_NODE;
        }
        let beyond_node = cut.node(beyond);
        match beyond_node.first_child {
            Some(children) if beyond_node.key.depth + 1 == node.key.depth => children + mirrored,
            Some(_) | None => beyond,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{NodeKey, NodeSummary};
    use glam::{DAffine3, UVec3};
    use proptest::prelude::*;
    use shaders::optics::{Curve, ExtinctionUnit};

    fn optics() -> Optics {
        Optics {
            domain: (0.0, 1.0),
            extinction: Curve::constant(1.0),
            extinction_unit: ExtinctionUnit::PerVoxel,
            colour: Curve::constant(glam::DVec3::ONE),
            mimda: None,
            refraction: None,
            materials: None,
            enhancers: Vec::new(),
        }
    }

    /// The live node at the key's depth or the coarser leaf above it.
    fn find(cut: &Cut, key: NodeKey) -> u32 {
        let mut at = 0;
        while let Some(first) = cut.node(at).first_child.filter(|_| cut.node(at).key.depth < key.depth) {
            let shift = u32::from(key.depth - cut.node(at).key.depth - 1);
            let bits = (key.cell >> UVec3::splat(shift)) & UVec3::ONE;
            at = first + (bits.x | bits.y << 1 | bits.z << 2);
        }
        at
    }

    proptest! {
        /// After any splits and collapses, every link leads to the node that a search from the root finds.
        #[test]
        fn links_lead_to_neighbours(choices in prop::collection::vec((0..200usize, any::<bool>()), 1..40)) {
            let shape = OctreeShape::new(UVec3::new(28 * 16, 28 * 16, 28 * 16));
            let lod = LodRule {
                display_from_volume: DAffine3::IDENTITY, pixel_size_m: 1.0, angular_accuracy: 0.01, lod_scale: 0.0,
            };
            let summary = |key| shape.contains(key).then_some(NodeSummary { min: 0.0, max: 1.0 });
            let mut cut = Cut::new(NodeSummary { min: 0.0, max: 1.0 });
            for (pick, collapse) in choices {
                if collapse {
                    let families = cut.collapsible(u64::MAX);
                    if !families.is_empty() {
                        cut.collapse(families[pick % families.len()]);
                    }
                } else {
                    let leaves: Vec<u32> = cut.walk()
                        .filter(|&p| cut.node(p).first_child.is_none() && cut.node(p).key.depth < 4).collect();
                    cut.split(leaves[pick % leaves.len()], summary);
                }
            }
            let optics = optics();
            let records = build_index(&cut, &IndexRules { shape: &shape, lod: &lod, optics: &optics, is_quadrilinear: false });
            for place in cut.walk() {
                let key = cut.node(place).key;
                for face in 0..6usize {
                    let mut cell = key.cell.as_ivec3();
                    cell[face / 2] += if face % 2 == 1 { 1 } else { -1 };
                    let inside = cell.min_element() >= 0 && cell.max_element() < 1 << key.depth;
                    let expected =
                        if inside { find(&cut, NodeKey { depth: key.depth, cell: cell.as_uvec3() }) } else { NO_NODE };
                    prop_assert_eq!(records[place as usize].neighbours[face], expected);
                }
            }
        }
    }
}
