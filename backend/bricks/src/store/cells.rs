//! The range of codes around each 4³ cell of a brick: it shows empty space inside the brick without reading voxels.

use super::CodeBits;
use crate::{BRICK_EDGE, BRICK_VOXELS, Codes};
use layout::{CELL_EDGE, CELL_WORDS, CELLS_ACROSS};

/// Cells of a brick.
const CELLS: usize = CELLS_ACROSS * CELLS_ACROSS * CELLS_ACROSS;
/// Samples are looked at in pairs, as both ends of every range are even.
const PAIRS: usize = BRICK_EDGE / 2;
/// Pairs of a cell, and beyond it on each side: two samples, one for interpolation and one for a step.
const PAIRS_OF_CELL: usize = CELL_EDGE / 2;
const PAIRS_BEYOND: usize = 1;

/// Smallest and largest code around each cell of a brick, x fastest: of the cell's samples and of two more on each
/// side, as far as the brick has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellRanges(Vec<[u16; 2]>);

impl CellRanges {
    /// Of a brick's codes.
    pub fn of(codes: &Codes) -> Self {
        match codes {
            Codes::U8(codes) => Self::of_samples(codes),
            Codes::U16(codes) => Self::of_samples(codes),
        }
    }

    /// Of 32³ samples.
    pub fn of_samples<T: Copy + Ord + Into<u16>>(samples: &[T]) -> Self {
        assert_eq!(samples.len(), BRICK_VOXELS, "a brick has 32³ samples");
        let (lows, highs) = (shrink(samples, T::min), shrink(samples, T::max));
        Self(lows.into_iter().zip(highs).map(|(low, high)| [low.into(), high.into()]).collect())
    }

    /// Where every code is the same.
    pub fn uniform(code: u16) -> Self {
        Self(vec![[code; 2]; CELLS])
    }

    /// The ranges of samples that are `factor` times the codes.
    pub fn scaled(mut self, factor: u16) -> Self {
        self.0.iter_mut().flatten().for_each(|code| *code *= factor);
        self
    }

    /// Smallest and largest code around each cell.
    pub fn ranges(&self) -> &[[u16; 2]] {
        &self.0
    }

    /// The bits of the cells for which `is_visible([x, y, z], [smallest, largest])`.
    pub fn visible(&self, is_visible: impl Fn([usize; 3], [u16; 2]) -> bool) -> [u32; CELL_WORDS] {
        let mut words = [0; CELL_WORDS];
        for (index, &range) in self.0.iter().enumerate() {
            let cell = [0, 1, 2].map(|axis| index / CELLS_ACROSS.pow(axis) % CELLS_ACROSS);
            words[index / 32] |= u32::from(is_visible(cell, range)) << (index % 32);
        }
        words
    }

    /// Smallest and largest code around the cell (x, y, z).
    pub fn around(&self, [x, y, z]: [usize; 3]) -> [u16; 2] {
        self.0[(z * CELLS_ACROSS + y) * CELLS_ACROSS + x]
    }

    /// Bytes of [`CellRanges::to_bytes`].
    pub(super) fn byte_count(bits: CodeBits) -> usize {
        2 * CELLS * usize::from(bits.bits()) / 8
    }

    /// As a store keeps them: codes of the brick's own size, little-endian.
    pub(super) fn to_bytes(&self, bits: CodeBits) -> Vec<u8> {
        match bits {
            CodeBits::Eight => self.0.iter().flatten().map(|&code| code as u8).collect(),
            CodeBits::Sixteen => self.0.iter().flatten().flat_map(|code| code.to_le_bytes()).collect(),
        }
    }

    /// The inverse of [`CellRanges::to_bytes`], of as many bytes as [`CellRanges::byte_count`] says.
    pub(super) fn from_bytes(bytes: &[u8], bits: CodeBits) -> Self {
        let (pairs, quads) = (bytes.as_chunks::<2>().0, bytes.as_chunks::<4>().0);
        Self(match bits {
            CodeBits::Eight => pairs.iter().map(|pair| pair.map(u16::from)).collect(),
            CodeBits::Sixteen => quads
                .iter()
                .map(|&[a, b, c, d]| [u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d])])
                .collect(),
        })
    }
}

/// Reduces 32³ samples to 8³ cells, one axis after the other, z first: whole planes, then whole rows at once.
fn shrink<T: Copy>(samples: &[T], pick: impl Fn(T, T) -> T + Copy) -> Vec<T> {
    let planes = shrink_axis(samples, BRICK_EDGE * BRICK_EDGE, pick);
    let rows = shrink_axis(&planes, BRICK_EDGE, pick);
    shrink_axis(&rows, 1, pick)
}

/// Reduces the axis whose neighbours are `inner` apart from 32 samples to 8 cells.
fn shrink_axis<T: Copy>(values: &[T], inner: usize, pick: impl Fn(T, T) -> T + Copy) -> Vec<T> {
    let mut out = Vec::with_capacity(values.len() / CELL_EDGE);
    let mut pairs = Vec::with_capacity(PAIRS * inner);
    for line in values.chunks_exact(BRICK_EDGE * inner) {
        pairs.clear();
        for pair in line.chunks_exact(2 * inner) {
            let (first, second) = pair.split_at(inner);
            pairs.extend(first.iter().zip(second).map(|(&a, &b)| pick(a, b)));
        }
        for cell in 0..CELLS_ACROSS {
            let first = (cell * PAIRS_OF_CELL).saturating_sub(PAIRS_BEYOND);
            let end = ((cell + 1) * PAIRS_OF_CELL + PAIRS_BEYOND).min(PAIRS);
            let start = out.len();
            out.extend_from_slice(&pairs[first * inner..(first + 1) * inner]);
            for pair in pairs[(first + 1) * inner..end * inner].chunks_exact(inner) {
                out[start..].iter_mut().zip(pair).for_each(|(kept, &value)| *kept = pick(*kept, value));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Brick;

    #[test]
    fn a_single_bright_texel_lights_the_cells_within_two_texels() {
        let mut samples = vec![7; BRICK_VOXELS];
        samples[Brick::index(9, 16, 31)] = 900;
        let ranges = CellRanges::of(&Codes::U16(samples));
        assert_eq!(ranges.0.len(), CELLS);
        let words = ranges.visible(|_, [_, high]| high > 7);
        for z in 0..8 {
            for y in 0..8 {
                for x in 0..8 {
                    let cell: usize = (z * 8 + y) * 8 + x;
                    let near = |c: usize, texel: usize| texel + 2 >= 4 * c && texel < 4 * c + 4 + 2;
                    let expected = near(x, 9) && near(y, 16) && near(z, 31);
                    assert_eq!(words[cell / 32] >> (cell % 32) & 1 == 1, expected, "{x} {y} {z}");
                }
            }
        }
    }

    #[test]
    fn bytes_read_back() {
        let codes: Vec<u8> = (0..BRICK_VOXELS).map(|i| (i * 7 % 251) as u8).collect();
        let wide = Codes::U16(codes.iter().map(|&code| u16::from(code) * 257).collect());
        let (eight, sixteen) = (CellRanges::of(&Codes::U8(codes)), CellRanges::of(&wide));
        for (ranges, bits) in [(&eight, CodeBits::Eight), (&sixteen, CodeBits::Sixteen)] {
            let bytes = ranges.to_bytes(bits);
            assert_eq!(bytes.len(), CellRanges::byte_count(bits));
            assert_eq!(CellRanges::from_bytes(&bytes, bits), *ranges);
        }
        assert_eq!(eight.scaled(257), sixteen);
    }
}
