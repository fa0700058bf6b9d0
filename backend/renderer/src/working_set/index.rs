//! The spatial index: the cut as rays traverse it.

use super::{Cut, CutNode};
use bricks::is_shown;
use bricks::{LodRule, MeasuredRule};
use bricks::{NodeSummary, OctreeShape};
use layout::{FULL_WEIGHTS, NO_NODE, NO_SLOT, NodeRecord, pack_weights};
use needs::{Compositing, Way};
use optics::Optics;

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
    /// A slot that holds no brick and all of whose cells show something; nodes that have no brick of their own and
    /// blend with their parent stand in it. None if nodes do not blend.
    pub blank_slot: Option<u32>,
    /// Of each slot: the largest standard deviation of its brick's samples, data units; empty where samples stand for
    /// themselves.
    pub deviations: &'a [f64],
}

/// What a record says of a node's samples.
struct Content {
    slot: u32,
    offset: f64,
    scale: f64,
    weights: [u32; 2],
}

impl Content {
    const EMPTY: Self = Self { slot: NO_SLOT, offset: 0.0, scale: 0.0, weights: FULL_WEIGHTS };
}

impl<'a> IndexRules<'a> {
    /// Nodes show their own samples alone, and these stand for themselves.
    pub fn new(shape: &'a OctreeShape, lod: &'a LodRule, optics: &'a Optics) -> Self {
        Self { shape, lod, optics, is_quadrilinear: false, blank_slot: None, deviations: &[] }
    }

    /// Whether a node leaves the picture as it is: outside the volume, or nothing visible in its range.
    pub fn is_empty(&self, node: &CutNode) -> bool {
        node.summary.is_none_or(|summary| !is_shown(self.optics, summary))
    }

    /// Levels that a node is too coarse by; at most 0 if no finer level exists.
    pub fn deficit(&self, node: &CutNode) -> f64 {
        self.deficit_by(&self.lod.measured(), node)
    }

    /// The same by the rule that was worked out before.
    pub(super) fn deficit_by(&self, rule: &MeasuredRule, node: &CutNode) -> f64 {
        let deficit = rule.deficit(self.shape, node.key);
        if node.key.depth == self.shape.finest_depth() { deficit.min(0.0) } else { deficit }
    }

    fn record(
        &self,
        rule: &MeasuredRule,
        cut: &Cut,
        place: u32,
        neighbours: [u32; 6],
        weights: [u32; 2],
    ) -> NodeRecord {
        let node = cut.node(place);
        let content = self.content(cut, node, weights);
        let (low, high) = self.optics.domain;
        NodeRecord {
            cell: node.key.cell.to_array(),
            depth: u32::from(node.key.depth),
            parent: node.parent.unwrap_or(NO_NODE),
            first_child: node.shown_child().unwrap_or(NO_NODE),
            slot: content.slot,
            deficit: self.deficit_by(rule, node) as f32,
            offset: content.offset as f32,
            scale: content.scale as f32,
            neighbours,
            most_extinction: self.most_extinction(cut, node, content.weights) as f32,
            weights: content.weights,
            deviation_scale: (self.deviation(node) / (high - low)) as f32,
        }
    }

    /// The largest standard deviation of what a node's samples stand for, data units.
    fn deviation(&self, node: &CutNode) -> f64 {
        node.brick.and_then(|brick| self.deviations.get(brick.slot as usize)).copied().unwrap_or(0.0)
    }

    /// A node that shows nothing has nothing to sample, unless it blends with a parent that does: then its own sample is
    /// the middle of its range, and the blend ends as smoothly as it does elsewhere. A node whose brick has not come
    /// shows its parent's samples.
    fn content(&self, cut: &Cut, node: &CutNode, weights: [u32; 2]) -> Content {
        let (low, high) = self.optics.domain;
        let scalar = |value: f64| (value - low) / (high - low);
        let is_empty = self.is_empty(node);
        if let (Some(brick), false) = (node.brick, is_empty) {
            let (offset, scale) = (scalar(brick.low), brick.span / (high - low));
            return Content { slot: brick.slot, offset, scale, weights };
        }
        let parent = node.parent.map(|parent| cut.node(parent));
        let has_parent = parent.is_some_and(|parent| parent.brick.is_some() && !self.is_empty(parent));
        match (self.blank_slot, node.summary) {
            (Some(slot), Some(_)) if has_parent && !is_empty => {
                Content { slot, offset: 0.0, scale: 0.0, weights: [0; 2] }
            }
            (Some(slot), Some(NodeSummary { min, max })) if has_parent && weights != FULL_WEIGHTS => {
                Content { slot, offset: scalar(0.5 * f64::from(min + max)), scale: 0.0, weights }
            }
            _ => Content::EMPTY,
        }
    }

    /// The most that enhancers multiply an extinction by in the node.
    fn most_factor(&self, node: &CutNode) -> f64 {
        if self.optics.enhancers.is_empty() {
            return 1.0;
        }
        let corners = self.shape.corners(node.key);
        self.optics.most_factor(&corners.map(|corner| self.lod.display_from_volume.transform_point3(corner)))
    }

    /// Steps may grow where extinction is low; not where importance or refraction acts, which have no part in
    /// it, nor where ancestors' values are blended in. The bounds of a parent are those of its children, too.
    fn most_extinction(&self, cut: &Cut, node: &CutNode, weights: [u32; 2]) -> f64 {
        if self.is_quadrilinear {
            return f64::from(f32::MAX);
        }
        let parent = node.parent.filter(|_| weights != FULL_WEIGHTS).map(|parent| cut.node(parent));
        let reach = parent.map_or(0.0, |parent| self.deviation(parent)).max(self.deviation(node));
        let summary = parent.map_or(node.summary, |parent| parent.summary);
        match (summary, Compositing::for_optics(self.optics), Way::for_optics(self.optics)) {
            (Some(NodeSummary { min, max }), Compositing::Over, Way::Straight) => {
                let bounds = [f64::from(min) - reach, f64::from(max) + reach];
                let [low, high] = bounds.map(|value| self.optics.normalise(value));
                self.optics.extinction.max_on(low, high) * self.most_factor(node)
            }
            (_, Compositing::Mimda(_), _) | (_, _, Way::Refracted) | (None, ..) => f64::from(f32::MAX),
        }
    }
}

/// One record per place of the cut, with its neighbour links. A link leads to the node beyond the face at the same
/// depth, or to the coarser leaf there. Rays meet what is shown; nodes blend by `weights` where there is a blank slot.
pub fn build_index(cut: &Cut, weights: &[[f32; 8]], rules: &IndexRules) -> Vec<NodeRecord> {
    let mut records: Vec<NodeRecord> = vec![bytemuck::Zeroable::zeroed(); cut.nodes().len()];
    let rule = rules.lod.measured();
    for place in cut.walk_shown() {
        let node = cut.node(place);
        let neighbours = match node.parent {
            None => [NO_NODE; 6],
            Some(parent) => links(cut, node, parent, records[parent as usize].neighbours, place),
        };
        let blend = match rules.blank_slot {
            Some(_) => pack_weights(weights[place as usize]),
            None => FULL_WEIGHTS,
        };
        records[place as usize] = rules.record(&rule, cut, place, neighbours, blend);
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
        match beyond_node.shown_child() {
            Some(children) if beyond_node.key.depth + 1 == node.key.depth => children + mirrored,
            Some(_) | None => beyond,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::working_set::{ResidentBrick, refresh, settle};
    use bricks::{NodeKey, NodeSummary};
    use glam::{DAffine3, UVec3};
    use optics::Curve;
    use proptest::prelude::*;

    fn optics() -> Optics {
        Optics::grey(Curve::constant(1.0))
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
                    let is_leaf = |child: u32| cut.node(child).first_child.is_none();
                    let is_lowest = |&place: &u32| {
                        cut.node(place).first_child.is_some_and(|first| (first..first + 8).all(is_leaf))
                    };
                    let families: Vec<u32> = cut.walk().filter(is_lowest).collect();
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
            let rules = IndexRules::new(&shape, &lod, &optics);
            let order: Vec<u32> = cut.walk().collect();
            refresh(&mut cut, &rules, &order);
            order.iter().for_each(|&place| cut.set_brick(place, ResidentBrick { slot: 0, low: 0.0, span: 1.0 }));
            settle(&mut cut);
            let records = build_index(&cut, &[], &rules);
            for place in cut.walk() {
                let key = cut.node(place).key;
                for face in 0..6usize {
                    let mut cell = key.cell.as_ivec3();
                    cell[face / 2] += if face % 2 == 1 { 1 } else { -1 };
                    let inside = cell.min_element() >= 0 && cell.max_element() < 1 << key.depth;
                    let expected =
                        if inside { cut.find(NodeKey { depth: key.depth, cell: cell.as_uvec3() }) } else { NO_NODE };
                    prop_assert_eq!(records[place as usize].neighbours[face], expected);
                }
            }
        }
    }
}
