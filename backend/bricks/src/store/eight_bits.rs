//! A source whose bricks are quantised to 8 bits as they are read: what a store of 8 bits would show of it.

use super::{CodeBits, quantise};
use crate::volume::{Modality, VolumeFrame};
use crate::{Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OctreeShape};
use std::sync::Arc;

/// The bricks of another source, each over its own range in 256 steps. Bricks that have 8 bits already stay as they
/// are. Coarse levels are those of the source, where a store built with 8 bits would round the same means.
#[derive(Clone)]
pub struct EightBits(Arc<dyn BrickSource>);

impl EightBits {
    /// The same volume in 8 bits.
    pub fn new(source: Arc<dyn BrickSource>) -> Self {
        Self(source)
    }
}

impl BrickSource for EightBits {
    fn shape(&self) -> OctreeShape {
        self.0.shape()
    }

    fn frame(&self) -> VolumeFrame {
        self.0.frame()
    }

    fn modality(&self) -> Modality {
        self.0.modality()
    }

    fn has_deviation(&self) -> bool {
        self.0.has_deviation()
    }

    fn value_range(&self) -> (f64, f64) {
        self.0.value_range()
    }

    /// Codes cannot leave the brick's own range, so the source's bounds hold.
    fn summary(&self, node: NodeKey) -> NodeSummary {
        self.0.summary(node)
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        let brick = self.0.brick(node)?;
        let Codes::U16(codes) = &brick.codes else { return Ok(brick) };
        let samples: Vec<f32> = (0..codes.len()).map(|index| brick.value(index) as f32).collect();
        Ok(Brick { deviation: brick.deviation, ..quantise(&samples, CodeBits::Eight) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::procedural::ProceduralVolume;
    use glam::UVec3;

    fn shells() -> Arc<dyn BrickSource> {
        Arc::new(ProceduralVolume::new("shells", UVec3::splat(40), 1e-3).unwrap())
    }

    #[test]
    fn every_sample_stays_within_half_a_step_and_within_the_source_s_bounds() {
        let source = shells();
        let eight = EightBits::new(Arc::clone(&source));
        for octant in 0..8 {
            let node = NodeKey::ROOT.child(octant);
            let (fine, coarse) = (source.brick(node).unwrap(), eight.brick(node).unwrap());
            assert_eq!(coarse.codes.largest(), 255);
            let NodeSummary { min, max } = eight.summary(node);
            for index in 0..crate::BRICK_VOXELS {
                let (was, is) = (fine.value(index), coarse.value(index));
                assert!((is - was).abs() <= 0.501 * f64::from(coarse.step), "{is} for {was}");
                assert!((f64::from(min)..=f64::from(max)).contains(&(is as f32).into()), "{is}");
            }
        }
    }

    #[test]
    fn eight_bits_of_eight_bits_are_the_same() {
        let once = EightBits::new(shells());
        let twice = EightBits::new(Arc::new(once.clone()));
        assert_eq!(once.brick(NodeKey::ROOT).unwrap(), twice.brick(NodeKey::ROOT).unwrap());
        assert_eq!(once.shape(), twice.shape());
        assert_eq!(once.value_range(), twice.value_range());
    }
}
