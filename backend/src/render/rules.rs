//! What one frame asks of the cut and its bricks.

use crate::store::CellRanges;
use crate::working_set::{LodRule, ResidentBrick};
use shaders::layout::CELL_WORDS;
use shaders::optics::Optics;
use shaders::tables::Tables;

/// What one frame asks of the cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameRules<'a> {
    pub(super) lod: LodRule,
    pub(super) optics: &'a Optics,
    pub(super) tables: &'a Tables,
    /// Whether steps are short enough for the margin that cells are kept with.
    pub(super) can_pass_over: bool,
}

impl FrameRules<'_> {
    /// The bits of the cells of a brick that show anything.
    pub(super) fn visible_cells(&self, ranges: &CellRanges, brick: ResidentBrick) -> [u32; CELL_WORDS] {
        let (low, high) = self.optics.domain;
        let scalar =
            |sample: u16| (brick.low + brick.span * f64::from(sample) / 65535.0 - low) / (high - low);
        ranges
            .visible(|least, most| !self.can_pass_over || !self.tables.is_vacant(scalar(least), scalar(most)))
    }
}
