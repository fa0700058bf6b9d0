//! What one frame asks of the cut and its bricks.

use super::ancestors::Ancestor;
use super::brick_ranges::BrickRanges;
use crate::working_set::IndexRules;
use bricks::LodRule;
use bricks::OctreeShape;
use layout::CELL_WORDS;
use needs::tables::Tables;
use optics::Optics;

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
    /// Whether samples of coarse levels stand for the scalars within their standard deviation.
    pub(super) spreads: bool,
}

impl FrameRules<'_> {
    /// What the index is made from.
    pub(super) fn for_index<'a>(&'a self, shape: &'a OctreeShape, blank_slot: u32) -> IndexRules<'a> {
        IndexRules {
            is_quadrilinear: self.is_quadrilinear,
            blank_slot: self.blends.then_some(blank_slot),
            ..IndexRules::new(shape, &self.lod, self.optics)
        }
    }

    /// The bits of the cells of a brick that show anything; blended with ancestors, where the scene does that.
    pub(super) fn visible_cells(&self, own: &BrickRanges, ancestors: &[Ancestor]) -> [u32; CELL_WORDS] {
        if !self.can_pass_over {
            return [u32::MAX; CELL_WORDS];
        }
        let (start, end) = self.optics.domain;
        own.samples.visible(|cell, _| {
            let values = own.values_in(std::iter::once(cell), self.spreads);
            let [low, high] = ancestors.iter().fold(values, |[low, high], ancestor| {
                let [least, most] = ancestor.values_around(cell, self.spreads);
                [low.min(least), high.max(most)]
            });
            let scalar = |value: f64| (value - start) / (end - start);
            !self.tables.is_vacant(scalar(low), scalar(high))
        })
    }
}
