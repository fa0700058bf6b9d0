//! How DICOM packs a number into the bits of a pixel, and its unpacking.

use bricks::volume::{ByteOrder, Element, Samples};

/// The bits of a pixel (PS3.5, 8.1.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PixelFormat {
    /// Bits of the cell: 8, 16 or 32.
    pub allocated: u16,
    /// Bits of the number in the cell.
    pub stored: u16,
    /// Place of the number's highest bit.
    pub high_bit: u16,
    /// Whether the highest bit is the sign, as two's complement.
    pub is_signed: bool,
}

impl PixelFormat {
    /// The type that holds the numbers; None if the bits make no sense, or are not read here.
    pub fn element(&self) -> Option<Element> {
        let fits = self.stored >= 1 && self.high_bit < self.allocated && self.stored <= self.high_bit + 1;
        match (fits, self.allocated, self.is_signed) {
            (true, 8, false) => Some(Element::U8),
            (true, 8, true) => Some(Element::I8),
            (true, 16, false) => Some(Element::U16),
            (true, 16, true) => Some(Element::I16),
            (true, 32, false) => Some(Element::U32),
            (true, 32, true) => Some(Element::I32),
            _ => None,
        }
    }

    /// The number in a cell.
    fn number(&self, cell: u32) -> i64 {
        let shifted = i64::from(cell >> (self.high_bit + 1 - self.stored));
        let unused = 64 - u32::from(self.stored);
        match self.is_signed {
            true => shifted << unused >> unused,
            false => ((shifted as u64) << unused >> unused) as i64,
        }
    }

    /// Writes the numbers of `bytes` (cells, lowest byte first) to `slab`, whose type is [`PixelFormat::element`]
    /// or, where they are scaled, f32.
    pub fn unpack(&self, bytes: &[u8], scaling: (f64, f64), slab: &mut Samples) {
        if self.stored == self.allocated && !slab.element().is_float() {
            slab.bytes_mut().copy_from_slice(bytes);
            return slab.reorder(ByteOrder::Little);
        }
        match slab {
            Samples::U8(values) => self.fill(bytes, values, |number| number as u8),
            Samples::I8(values) => self.fill(bytes, values, |number| number as i8),
            Samples::U16(values) => self.fill(bytes, values, |number| number as u16),
            Samples::I16(values) => self.fill(bytes, values, |number| number as i16),
            Samples::U32(values) => self.fill(bytes, values, |number| number as u32),
            Samples::I32(values) => self.fill(bytes, values, |number| number as i32),
            Samples::F32(values) => {
                self.fill(bytes, values, |number| (number as f64 * scaling.0 + scaling.1) as f32)
            }
            _ => unreachable!("no pixel format has the type {}", slab.element()),
        }
    }

    fn fill<T>(&self, bytes: &[u8], values: &mut [T], convert: impl Fn(i64) -> T) {
        let cells = bytes.chunks_exact(usize::from(self.allocated / 8));
        for (value, cell) in values.iter_mut().zip(cells) {
            let cell = cell.iter().rev().fold(0, |cell, &byte| cell << 8 | u32::from(byte));
            *value = convert(self.number(cell));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_bits_in_sixteen_keep_their_sign_and_lose_what_lies_beside() {
        let format = PixelFormat { allocated: 16, stored: 12, high_bit: 11, is_signed: true };
        let mut slab = Samples::new(Element::I16, 3);
        format.unpack(&[0xff, 0xff, 0x00, 0x78, 0x00, 0x10], (1.0, 0.0), &mut slab);
        assert_eq!(slab, Samples::I16(vec![-1, -2048, 0]));
        let high = PixelFormat { high_bit: 15, is_signed: false, ..format };
        let mut slab = Samples::new(Element::U16, 1);
        high.unpack(&[0xff, 0xff], (1.0, 0.0), &mut slab);
        assert_eq!(slab, Samples::U16(vec![4095]));
    }

    #[test]
    fn bits_that_do_not_fit_have_no_type() {
        let format = PixelFormat { allocated: 16, stored: 12, high_bit: 11, is_signed: false };
        assert_eq!(format.element(), Some(Element::U16));
        assert_eq!(PixelFormat { stored: 0, ..format }.element(), None);
        assert_eq!(PixelFormat { high_bit: 10, ..format }.element(), None);
        assert_eq!(PixelFormat { high_bit: 16, ..format }.element(), None);
        assert_eq!(PixelFormat { allocated: 1, stored: 1, high_bit: 0, ..format }.element(), None);
    }
}
