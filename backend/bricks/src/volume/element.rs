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
    /// Unsigned, 8 bytes.
    U64,
    /// Signed, 8 bytes.
    I64,
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
            Element::U64 | Element::I64 | Element::F64 => 8,
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
            "u64" | "uint64" | "uint64_t" | "ulonglong" | "unsigned long long" | "unsigned long long int" => {
                Element::U64
            }
            "i64"
            | "int64"
            | "int64_t"
            | "longlong"
            | "long long"
            | "long long int"
            | "signed long long"
            | "signed long long int" => Element::I64,
            "f32" | "float" | "float32" => Element::F32,
            "f64" | "double" | "float64" => Element::F64,
            _ => return None,
        })
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
            Element::U64 => "uint64",
            Element::I64 => "int64",
            Element::F32 => "float32",
            Element::F64 => "float64",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
