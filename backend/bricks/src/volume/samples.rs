//! Voxels in the type that their file stores them in.

use super::{ByteOrder, Element};

/// Stored numbers, not yet scaled: one slab of a volume, or any other run of voxels.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Of [`Element::U8`].
    U8(Vec<u8>),
    /// Of [`Element::I8`].
    I8(Vec<i8>),
    /// Of [`Element::U16`].
    U16(Vec<u16>),
    /// Of [`Element::I16`].
    I16(Vec<i16>),
    /// Of [`Element::U32`].
    U32(Vec<u32>),
    /// Of [`Element::I32`].
    I32(Vec<i32>),
    /// Of [`Element::U64`].
    U64(Vec<u64>),
    /// Of [`Element::I64`].
    I64(Vec<i64>),
    /// Of [`Element::F32`].
    F32(Vec<f32>),
    /// Of [`Element::F64`].
    F64(Vec<f64>),
}

/// Runs the same code for whatever [`Samples`] hold: `with_samples!(samples, |values| values.len())`.
macro_rules! with_samples {
    ($samples:expr, |$values:ident| $body:expr) => {
        match $samples {
            $crate::volume::Samples::U8($values) => $body,
            $crate::volume::Samples::I8($values) => $body,
            $crate::volume::Samples::U16($values) => $body,
            $crate::volume::Samples::I16($values) => $body,
            $crate::volume::Samples::U32($values) => $body,
            $crate::volume::Samples::I32($values) => $body,
            $crate::volume::Samples::U64($values) => $body,
            $crate::volume::Samples::I64($values) => $body,
            $crate::volume::Samples::F32($values) => $body,
            $crate::volume::Samples::F64($values) => $body,
        }
    };
}

pub(crate) use with_samples;

impl Samples {
    /// `count` zeros of a type.
    pub fn new(element: Element, count: usize) -> Self {
        match element {
            Element::U8 => Samples::U8(vec![0; count]),
            Element::I8 => Samples::I8(vec![0; count]),
            Element::U16 => Samples::U16(vec![0; count]),
            Element::I16 => Samples::I16(vec![0; count]),
            Element::U32 => Samples::U32(vec![0; count]),
            Element::I32 => Samples::I32(vec![0; count]),
            Element::U64 => Samples::U64(vec![0; count]),
            Element::I64 => Samples::I64(vec![0; count]),
            Element::F32 => Samples::F32(vec![0.0; count]),
            Element::F64 => Samples::F64(vec![0.0; count]),
        }
    }

    /// The type.
    pub fn element(&self) -> Element {
        match self {
            Samples::U8(_) => Element::U8,
            Samples::I8(_) => Element::I8,
            Samples::U16(_) => Element::U16,
            Samples::I16(_) => Element::I16,
            Samples::U32(_) => Element::U32,
            Samples::I32(_) => Element::I32,
            Samples::U64(_) => Element::U64,
            Samples::I64(_) => Element::I64,
            Samples::F32(_) => Element::F32,
            Samples::F64(_) => Element::F64,
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        with_samples!(self, |values| values.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The stored number at a place; 64-bit integers beyond 2⁵³ are rounded.
    pub fn get(&self, index: usize) -> f64 {
        with_samples!(self, |values| Sample::to_f64(values[index]))
    }

    /// Sets the number at a place, rounded and clamped to the type's as `as` does.
    pub fn set(&mut self, index: usize, value: f64) {
        match self {
            Samples::U8(values) => values[index] = value as u8,
            Samples::I8(values) => values[index] = value as i8,
            Samples::U16(values) => values[index] = value as u16,
            Samples::I16(values) => values[index] = value as i16,
            Samples::U32(values) => values[index] = value as u32,
            Samples::I32(values) => values[index] = value as i32,
            Samples::U64(values) => values[index] = value as u64,
            Samples::I64(values) => values[index] = value as i64,
            Samples::F32(values) => values[index] = value as f32,
            Samples::F64(values) => values[index] = value,
        }
    }

    /// The memory of the numbers, in this machine's byte order.
    pub fn bytes(&self) -> &[u8] {
        with_samples!(self, |values| bytemuck::cast_slice(values.as_slice()))
    }

    /// The memory of the numbers, to be filled from a file; [`Samples::reorder`] comes after.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        with_samples!(self, |values| bytemuck::cast_slice_mut(values.as_mut_slice()))
    }

    /// Turns numbers whose bytes are in a file's order into those of this machine.
    pub fn reorder(&mut self, order: ByteOrder) {
        let is_native = cfg!(target_endian = "little") == (order == ByteOrder::Little);
        let bytes = self.element().bytes();
        if !is_native && bytes > 1 {
            self.bytes_mut().chunks_exact_mut(bytes).for_each(<[u8]>::reverse);
        }
    }
}

/// A number as files store it.
pub trait Sample: Copy + Send + Sync + 'static {
    /// Whether every number of the type is one of f32.
    const IS_EXACT_IN_F32: bool;
    /// The number; 64-bit integers beyond 2⁵³ are rounded.
    fn to_f64(self) -> f64;
    /// The nearest f32.
    fn to_f32(self) -> f32;
}

macro_rules! sample {
    ($($number:ty, $is_exact:literal;)*) => {$(
        impl Sample for $number {
            const IS_EXACT_IN_F32: bool = $is_exact;
            fn to_f64(self) -> f64 {
                self as f64
            }
            fn to_f32(self) -> f32 {
                self as f32
            }
        }
    )*};
}

sample! {
    u8, true; i8, true; u16, true; i16, true; u32, false; i32, false; u64, false; i64, false; f32, true; f64, false;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_give_the_same_number() {
        let mut big = Samples::new(Element::I16, 1);
        big.bytes_mut().copy_from_slice(&(-1234i16).to_be_bytes());
        big.reorder(ByteOrder::Big);
        assert_eq!(big, Samples::I16(vec![-1234]));
        let mut little = Samples::new(Element::F64, 1);
        little.bytes_mut().copy_from_slice(&0.1f64.to_le_bytes());
        little.reorder(ByteOrder::Little);
        assert_eq!(little.get(0), 0.1);
    }
}
