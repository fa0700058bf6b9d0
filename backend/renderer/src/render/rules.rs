//! What one frame asks of the cut and its bricks.

use super::ancestors::Ancestor;
use crate::working_set::{IndexRules, ResidentBrick};
use bricks::LodRule;
use bricks::{CellRanges, OctreeShape};
use layout::CELL_WORDS;
use optics::Optics;
use shaders::tables::Tables;

/// What one frame asks of the cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameRules<'a> {
    pub(super) lod: LodRule,
    pub(super) optics: &'a Optics,
    pub(super) tables: &'a Tables,
    /// Whether steps are short enough for the margin that cells are kept with.
    pub(super) can_pass_over: bool,
    /// Whether samples are blended with those of the two ancestors.
    pub(super) is_quadrilinear: bool,
    /// Whether nodes blend into their parents.
    pub(super) blends: bool,
}

impl FrameRules<'_> {
    /// What the index is made from.
    pub(super) fn for_index<'a>(&'a self, shape: &'a OctreeShape, blank_slot: u32) -> IndexRules<'a> {
        IndexRules {
            shape,
            lod: &self.lod,
            optics: self.optics,
            is_quadrilinear: self.is_quadrilinear,
            blank_slot: self.blends.then_some(blank_slot),
        }
    }

    /// The bits of the cells of a brick that show anything; blended with ancestors, where the scene does that.
    pub(super) fn visible_cells(
        &self,
        ranges: &CellRanges,
        brick: ResidentBrick,
        ancestors: &[Ancestor],
    ) -> [u32; CELL_WORDS] {
        if !self.can_pass_over {
            return [u32::MAX; CELL_WORDS];
        }
        ranges.visible(|cell, range| {
            let own = self.scalars(brick, range);
            let (low, high) = ancestors.iter().fold(own, |(low, high), ancestor| {
                let (least, most) = self.scalars(ancestor.brick, ancestor.range_around(cell));
                (low.min(least), high.max(most))
            });
            !self.tables.is_vacant(low, high)
        })
    }

    /// The scalars of a range of samples.
    fn scalars(&self, brick: ResidentBrick, samples: [u16; 2]) -> (f64, f64) {
        let (low, high) = self.optics.domain;
        let scalar =
            |sample: u16| (brick.low + brick.span * f64::from(sample) / 65535.0 - low) / (high - low);
        (scalar(samples[0]), scalar(samples[1]))
    }
}
