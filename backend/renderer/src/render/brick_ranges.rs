//! What is known of the values in a resident brick's cells.

use crate::working_set::ResidentBrick;
use bricks::CellRanges;

/// The values in the cells of a resident brick.
#[derive(Clone, Copy, Debug)]
pub(super) struct BrickRanges<'a> {
    pub(super) brick: ResidentBrick,
    /// The range of the samples around each cell.
    pub(super) samples: &'a CellRanges,
    /// The range of the deviations around each cell, and the deviation of code 255 in data units.
    pub(super) deviations: Option<(&'a CellRanges, f64)>,
}

impl BrickRanges<'_> {
    /// Smallest and largest data value that the samples around some cells stand for; with `spreads`, that is more than
    /// themselves.
    pub(super) fn values_in(
        &self,
        cells: impl Iterator<Item = [usize; 3]> + Clone,
        spreads: bool,
    ) -> [f64; 2] {
        let over = |ranges: &CellRanges| {
            cells.clone().fold([u16::MAX, 0], |[low, high], cell| {
                let [least, most] = ranges.around(cell);
                [low.min(least), high.max(most)]
            })
        };
        let reach = |(ranges, largest): (&CellRanges, f64)| largest * f64::from(over(ranges)[1]) / 255.0;
        let reach = self.deviations.filter(|_| spreads).map_or(0.0, reach);
        let value = |sample: u16| self.brick.low + self.brick.span * f64::from(sample) / 65535.0;
        let [low, high] = over(self.samples).map(value);
        [low - reach, high + reach]
    }
}
