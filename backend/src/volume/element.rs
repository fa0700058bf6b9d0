//! The number type of a stored voxel.

/// How a voxel is stored in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// Unsigned, 1 byte.
    U8,
    /// Signed, 1 byte.
    I8,
    /// Unsigned, 2 bytes.
    U16,
    /// Signed, 2 bytes.
    I16,
    /// Unsigned, 4 bytes.
    U32,
    /// Signed, 4 bytes.
    I32,
    /// IEEE single precision.
    F32,
    /// IEEE double precision.
    F64,
}

/// Order of the bytes of a stored number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

impl Element {
    /// Bytes per voxel.
    pub fn bytes(self) -> usize {
        match self {
            Element::U8 | Element::I8 => 1,
            Element::U16 | Element::I16 => 2,
            Element::U32 | Element::I32 | Element::F32 => 4,
            Element::F64 => 8,
        }
    }

    /// Whether NaN and infinity can occur.
    pub fn is_float(self) -> bool {
        matches!(self, Element::F32 | Element::F64)
    }

    /// The type of that name: the names of NRRD and of C (`uint8`, `unsigned short`, `float`), and short ones (`u8`, `f32`).
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match name.trim().to_ascii_lowercase().as_str() {
            "u8" | "uint8" | "uint8_t" | "uchar" | "unsigned char" => Element::U8,
            "i8" | "int8" | "int8_t" | "char" | "signed char" => Element::I8,
            "u16" | "uint16" | "uint16_t" | "ushort" | "unsigned short" | "unsigned short int" => {
                Element::U16
            }
            "i16" | "int16" | "int16_t" | "short" | "short int" | "signed short" | "signed short int" => {
                Element::I16
            }
            "u32" | "uint32" | "uint32_t" | "uint" | "unsigned int" => Element::U32,
            "i32" | "int32" | "int32_t" | "int" | "signed int" => Element::I32,
            "f32" | "float" | "float32" => Element::F32,
            "f64" | "double" | "float64" => Element::F64,
            _ => return None,
        })
    }

    /// Turns stored bytes into numbers; `bytes` holds exactly `values.len()` voxels.
    pub(super) fn decode(self, order: ByteOrder, bytes: &[u8], values: &mut [f64]) {
        debug_assert_eq!(bytes.len(), values.len() * self.bytes());
        match self {
            Element::U8 => each(bytes, values, order, |b: [u8; 1]| f64::from(b[0])),
            Element::I8 => each(bytes, values, order, |b| f64::from(i8::from_le_bytes(b))),
            Element::U16 => each(bytes, values, order, |b| f64::from(u16::from_le_bytes(b))),
            Element::I16 => each(bytes, values, order, |b| f64::from(i16::from_le_bytes(b))),
            Element::U32 => each(bytes, values, order, |b| f64::from(u32::from_le_bytes(b))),
            Element::I32 => each(bytes, values, order, |b| f64::from(i32::from_le_bytes(b))),
            Element::F32 => each(bytes, values, order, |b| f64::from(f32::from_le_bytes(b))),
            Element::F64 => each(bytes, values, order, f64::from_le_bytes),
        }
    }
}

impl std::fmt::Display for Element {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Element::U8 => "uint8",
            Element::I8 => "int8",
            Element::U16 => "uint16",
            Element::I16 => "int16",
            Element::U32 => "uint32",
            Element::I32 => "int32",
            Element::F32 => "float32",
            Element::F64 => "float64",
        })
    }
}

fn each<const N: usize>(bytes: &[u8], values: &mut [f64], order: ByteOrder, number: impl Fn([u8; N]) -> f64) {
    let (stored, _) = bytes.as_chunks::<N>();
    match order {
        ByteOrder::Little => values.iter_mut().zip(stored).for_each(|(value, b)| *value = number(*b)),
        ByteOrder::Big => values.iter_mut().zip(stored).for_each(|(value, b)| {
            let mut b = *b;
            b.reverse();
            *value = number(b);
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_give_the_same_number() {
        let mut value = [0.0];
        Element::I16.decode(ByteOrder::Little, &(-1234i16).to_le_bytes(), &mut value);
        assert_eq!(value, [-1234.0]);
        Element::F64.decode(ByteOrder::Big, &0.1f64.to_be_bytes(), &mut value);
        assert_eq!(value, [0.1]);
    }

    #[test]
    fn a_type_answers_to_its_own_name() {
        for element in
            [Element::U8, Element::I8, Element::U16, Element::I16, Element::U32, Element::I32, Element::F32]
        {
            assert_eq!(Element::from_name(&element.to_string()), Some(element));
        }
        assert_eq!(Element::from_name("block"), None);
    }
}
