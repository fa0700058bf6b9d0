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
    /// Whether the whole cell is a float of 32 or 64 bits, as in parametric maps (PS3.3 C.7.6.24 and 25).
    pub is_float: bool,
}

impl PixelFormat {
    /// The type that holds the numbers; None if the bits make no sense, or are not read here.
    pub fn element(&self) -> Option<Element> {
        if self.is_float {
            return if self.allocated == 32 { Some(Element::F32) } else { Some(Element::F64) };
        }
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

    /// Writes the numbers of `bytes` (cells, lowest byte first) to `slab`, whose type is [`PixelFormat::element`]; or,
    /// given a slope and an intercept, their values to one of f32.
    pub fn unpack(&self, bytes: &[u8], scaling: Option<(f64, f64)>, slab: &mut Samples) {
        if let (Some(scaling), Samples::F32(values)) = (scaling, &mut *slab) {
            return self.fill_scaled(bytes, scaling, values);
        }
        if self.is_float || self.stored == self.allocated {
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
            _ => unreachable!("no pixel format has the type {}", slab.element()),
        }
    }

    fn fill_scaled(&self, bytes: &[u8], (slope, intercept): (f64, f64), values: &mut [f32]) {
        let scaled = |number: f64| (number * slope + intercept) as f32;
        let pairs =
            |values| std::iter::zip::<&mut [f32], _>(values, bytes.chunks(usize::from(self.allocated / 8)));
        match (self.is_float, self.allocated) {
            (false, _) => self.fill(bytes, values, |number| scaled(number as f64)),
            (true, 32) => pairs(values).for_each(|(value, cell)| *value = scaled(f32_in(cell).into())),
            (true, _) => pairs(values).for_each(|(value, cell)| *value = scaled(f64_in(cell))),
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

fn f32_in(cell: &[u8]) -> f32 {
    f32::from_le_bytes(std::array::from_fn(|i| cell[i]))
}

fn f64_in(cell: &[u8]) -> f64 {
    f64::from_le_bytes(std::array::from_fn(|i| cell[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_bits_in_sixteen_keep_their_sign_and_lose_what_lies_beside() {
        let format =
            PixelFormat { allocated: 16, stored: 12, high_bit: 11, is_signed: true, is_float: false };
        let mut slab = Samples::new(Element::I16, 3);
        format.unpack(&[0xff, 0xff, 0x00, 0x78, 0x00, 0x10], None, &mut slab);
        assert_eq!(slab, Samples::I16(vec![-1, -2048, 0]));
        let high = PixelFormat { high_bit: 15, is_signed: false, ..format };
        let mut slab = Samples::new(Element::U16, 1);
        high.unpack(&[0xff, 0xff], None, &mut slab);
        assert_eq!(slab, Samples::U16(vec![4095]));
    }

    #[test]
    fn floats_are_taken_as_they_are_or_scaled() {
        let bytes = [1.5f64, -2.0].map(f64::to_le_bytes).concat();
        let format =
            PixelFormat { allocated: 64, stored: 64, high_bit: 63, is_signed: false, is_float: true };
        let mut slab = Samples::new(format.element().unwrap(), 2);
        format.unpack(&bytes, None, &mut slab);
        assert_eq!(slab, Samples::F64(vec![1.5, -2.0]));
        let mut slab = Samples::new(Element::F32, 2);
        format.unpack(&bytes, Some((2.0, 1.0)), &mut slab);
        assert_eq!(slab, Samples::F32(vec![4.0, -3.0]));
        let bytes = [1.5f32, -2.0].map(f32::to_le_bytes).concat();
        PixelFormat { allocated: 32, ..format }.unpack(&bytes, Some((2.0, 1.0)), &mut slab);
        assert_eq!(slab, Samples::F32(vec![4.0, -3.0]));
    }

    #[test]
    fn bits_that_do_not_fit_have_no_type() {
        let format =
            PixelFormat { allocated: 16, stored: 12, high_bit: 11, is_signed: false, is_float: false };
        assert_eq!(format.element(), Some(Element::U16));
        assert_eq!(PixelFormat { stored: 0, ..format }.element(), None);
        assert_eq!(PixelFormat { high_bit: 10, ..format }.element(), None);
        assert_eq!(PixelFormat { high_bit: 16, ..format }.element(), None);
        assert_eq!(PixelFormat { allocated: 1, stored: 1, high_bit: 0, ..format }.element(), None);
    }
}
