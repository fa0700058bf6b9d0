//! The pixels of a raster in four classes, by the last bit of their column and row: each sub-frame casts one of them.

use protocol::SubFrame;
use twin::Lattice;

/// A set of these classes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Classes(u8);

impl Classes {
    /// Every pixel.
    pub const ALL: Self = Self(0b1111);

    /// The class of a pixel alone.
    pub fn of_pixel(x: usize, y: usize) -> Self {
        Self(1 << ((x & 1) + 2 * (y & 1)))
    }

    /// The classes that a lattice casts, which is one of [`lattice_of`].
    pub fn of_lattice(lattice: &Lattice) -> Self {
        let along = |axis: usize| (lattice.first[axis]..2).step_by(lattice.step[axis] as usize);
        let classes = along(1).flat_map(|y| along(0).map(move |x| Self::of_pixel(x as usize, y as usize)));
        classes.fold(Self::default(), Self::with)
    }

    /// A bit for each class: that of pixel (x, y) is number (x mod 2) + 2 (y mod 2).
    #[cfg(feature = "gpu")]
    pub fn bits(self) -> u32 {
        self.0.into()
    }

    /// Both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// These without the others.
    #[must_use]
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether a pixel is of one of them.
    pub fn has(self, x: usize, y: usize) -> bool {
        self.0 & Self::of_pixel(x, y).0 != 0
    }

    /// Whether all pixels of a row are of some of them.
    pub(super) fn has_row(self, y: usize) -> bool {
        self.has(0, y) && self.has(1, y)
    }

    /// Whether these are every other row.
    pub(super) fn are_rows(self) -> bool {
        matches!(self.0, 0b0011 | 0b1100)
    }

    /// Whether these are every other column.
    pub(super) fn are_columns(self) -> bool {
        matches!(self.0, 0b0101 | 0b1010)
    }

    /// Where this is one class: that of its pixels' diagonal neighbours.
    pub(super) fn diagonal_of_one(self) -> Option<Self> {
        let swapped = (self.0 & 1) << 3 | (self.0 & 2) << 1 | (self.0 & 4) >> 1 | self.0 >> 3;
        (self.0.count_ones() == 1).then_some(Self(swapped))
    }
}

/// The pixels that a frame casts: all, or those of a sub-frame; where whole rows are cast, the rows that hold these.
pub fn lattice_of(sub_frame: Option<SubFrame>, has_rows: bool) -> Lattice {
    let Some([x, y]) = sub_frame.map(SubFrame::first_pixel) else { return Lattice::ALL };
    match has_rows {
        true => Lattice { step: [1, 2], first: [0, y] },
        false => Lattice { step: [2, 2], first: [x, y] },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sub_frames_cast_every_pixel_once_and_the_diagonal_second() {
        let classes = SubFrame::ORDER.map(|sub| Classes::of_lattice(&lattice_of(Some(sub), false)));
        assert_eq!(classes.into_iter().fold(Classes::default(), Classes::with), Classes::ALL);
        assert_eq!(classes[0].diagonal_of_one(), Some(classes[1]));
        assert_eq!(classes[2].diagonal_of_one(), Some(classes[3]));
        assert_eq!(Classes::ALL.without(classes[1]).diagonal_of_one(), None);
        assert_eq!(Classes::of_lattice(&Lattice::ALL), Classes::ALL);
    }

    #[test]
    fn two_sub_frames_in_a_row_cast_every_row() {
        for pair in [[0, 1], [1, 2], [2, 3], [3, 0]] {
            let rows = pair.map(|i| Classes::of_lattice(&lattice_of(Some(SubFrame::ORDER[i]), true)));
            assert_eq!(rows[0].with(rows[1]), Classes::ALL);
            assert_ne!(rows[0], Classes::ALL);
        }
    }
}
