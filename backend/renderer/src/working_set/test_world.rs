//! A made-up volume for the laws of the live working set: random ranges, no voxels.

use super::{Cut, IndexRules, corner_weights};
use bricks::LodRule;
use bricks::{NodeKey, NodeSummary, OctreeShape};
use glam::{DAffine3, DVec3, UVec3};
use optics::{Curve, Optics};
use std::collections::HashMap;

/// Random numbers from a seed (SplitMix64).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(super) fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A volume whose finest nodes have random ranges.
pub(super) struct World {
    pub(super) shape: OctreeShape,
    summaries: HashMap<NodeKey, NodeSummary>,
}

impl World {
    pub(super) fn new(dims: UVec3, random: &mut Random) -> Self {
        let shape = OctreeShape::new(dims);
        let mut summaries: HashMap<NodeKey, NodeSummary> = HashMap::new();
        for depth in (0..=shape.finest_depth()).rev() {
            for key in shape.nodes(depth) {
                let below: Vec<NodeSummary> =
                    (0..8).filter_map(|octant| summaries.get(&key.child(octant)).copied()).collect();
                let own = match below.is_empty() {
                    true => {
                        let min = random.unit() as f32;
                        NodeSummary { min, max: min + 0.3 * random.unit() as f32 }
                    }
                    false => below
                        .iter()
                        .fold(below[0], |a, b| NodeSummary { min: a.min.min(b.min), max: a.max.max(b.max) }),
                };
                summaries.insert(key, own);
            }
        }
        Self { shape, summaries }
    }

    pub(super) fn summary(&self, key: NodeKey) -> NodeSummary {
        self.summaries[&key]
    }
}

/// Shows values above `threshold`.
pub(super) fn optics(threshold: f64) -> Optics {
    let extinction = Curve::new(vec![(0.0, 0.0), (threshold, 0.0), (1.0, 1.0)]).unwrap();
    Optics { domain: (0.0, 1.3), ..Optics::grey(extinction) }
}

/// The centre of the volume stands at depth z; the finest voxel is a millimetre.
pub(super) fn rule(shape: &OctreeShape, z: f64) -> LodRule {
    let centre = shape.dims().as_dvec3() * 0.5e-3;
    let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, z) - centre);
    LodRule {
        display_from_volume: place * DAffine3::from_scale(DVec3::splat(1e-3)),
        pixel_size_m: 1e-3,
        angular_accuracy: 0.02,
        lod_scale: 1.0,
    }
}

/// The rules of a frame in which nothing is filtered over levels.
pub(super) fn rules<'a>(shape: &'a OctreeShape, lod: &'a LodRule, optics: &'a Optics) -> IndexRules<'a> {
    IndexRules::new(shape, lod, optics)
}

/// The weights of a cut of which nothing is lost.
pub(super) fn live_weights(cut: &Cut) -> Vec<[f32; 8]> {
    let shape = OctreeShape::new(UVec3::ONE);
    let (lod, optics) = (rule(&shape, 0.0), optics(0.5));
    corner_weights(cut, &rules(&shape, &lod, &optics), &|_| NodeSummary { min: 0.0, max: 0.0 }, |_| false)
}
