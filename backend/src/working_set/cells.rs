//! The range of samples around each 4³ cell of a brick: what tells empty space inside it.

use crate::store::{BRICK_EDGE, BRICK_VOXELS};
use shaders::layout::{CELL_EDGE, CELL_WORDS, CELLS_ACROSS};

/// Texels beyond a cell that count as around it: one for interpolation, one for the step.
const MARGIN: usize = 2;
/// Cells of a brick.
#[cfg(test)]
const CELLS: usize = CELLS_ACROSS * CELLS_ACROSS * CELLS_ACROSS;

/// Smallest and largest sample around each cell of a brick, x fastest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellRanges(Vec<(u16, u16)>);

impl CellRanges {
    /// Of 32³ samples.
    pub fn of(samples: &[u16]) -> Self {
        assert_eq!(samples.len(), BRICK_VOXELS, "a brick has 32³ samples");
        let pairs: Vec<(u16, u16)> = samples.iter().map(|&sample| (sample, sample)).collect();
        // One axis after the other: rows of 32 become rows of 8; the new axis goes last, so three turns end in order.
        let turned = (0..3).fold(pairs, |values, _| shrink_first_axis(&values));
        Self(turned)
    }

    /// The bits of the cells for which `is_visible(smallest, largest)`.
    pub fn visible(&self, is_visible: impl Fn(u16, u16) -> bool) -> [u32; CELL_WORDS] {
        let mut words = [0; CELL_WORDS];
        for (cell, &(low, high)) in self.0.iter().enumerate() {
            words[cell / 32] |= u32::from(is_visible(low, high)) << (cell % 32);
        }
        words
    }
}

/// Reduces the fastest axis from 32 texels to 8 cells, and makes it the slowest.
fn shrink_first_axis(values: &[(u16, u16)]) -> Vec<(u16, u16)> {
    let rows = values.len() / BRICK_EDGE;
    let mut out = vec![(u16::MAX, 0); rows * CELLS_ACROSS];
    for (row, texels) in values.chunks_exact(BRICK_EDGE).enumerate() {
        for cell in 0..CELLS_ACROSS {
            let first = (cell * CELL_EDGE).saturating_sub(MARGIN);
            let last = ((cell + 1) * CELL_EDGE + MARGIN).min(BRICK_EDGE);
            out[cell * rows + row] = texels[first..last]
                .iter()
                .fold((u16::MAX, 0), |(low, high), texel| (low.min(texel.0), high.max(texel.1)));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Brick;

    #[test]
    fn a_single_bright_texel_lights_the_cells_within_two_texels() {
        let mut samples = vec![7; BRICK_VOXELS];
        samples[Brick::index(9, 16, 31)] = 900;
        let ranges = CellRanges::of(&samples);
        assert_eq!(ranges.0.len(), CELLS);
        let words = ranges.visible(|_, high| high > 7);
        for z in 0..8 {
            for y in 0..8 {
                for x in 0..8 {
                    let cell: usize = (z * 8 + y) * 8 + x;
                    let near = |c: usize, texel: usize| texel + MARGIN >= 4 * c && texel < 4 * c + 4 + MARGIN;
                    let expected = near(x, 9) && near(y, 16) && near(z, 31);
                    assert_eq!(words[cell / 32] >> (cell % 32) & 1 == 1, expected, "{x} {y} {z}");
                }
            }
        }
    }
}
