//! How a DICOM file begins: with magic and meta group as files on discs do, or without them, as old programs and some
//! archives write it.

use super::syntax::{MAGIC, PREAMBLE_BYTES};
use bricks::volume::{VolumeError, open_file};
use dicom_dictionary_std::uids;
use std::fs::File;
use std::io::{Chain, Cursor, Read};
use std::path::Path;

/// Group and element of the first element of a meta group, its type, and the length of its value (PS3.10, 7.1).
const META_START: &[u8] = &[2, 0, 0, 0, b'U', b'L', 4, 0];
/// The group that elements begin with where there is no meta group, and the last of its elements that can be first.
const FIRST_GROUP: [u8; 2] = [8, 0];
const LAST_FIRST_ELEMENT: u8 = 0x18;
/// Types of the elements that can be first.
const FIRST_TYPES: [&[u8]; 6] = [b"UL", b"SH", b"CS", b"UI", b"DA", b"TM"];
/// Longer values are not believed of a first element.
const LONGEST_FIRST_VALUE: u32 = 1024;

/// What a file has before its elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// Magic and meta group, after so many bytes of preamble.
    Whole { preamble_bytes: usize },
    /// A meta group.
    Meta,
    /// Nothing; the elements look like those of this transfer syntax.
    Elements { syntax: &'static str },
}

impl Start {
    /// How a file with these first bytes begins; None if it is no DICOM file.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let is_magic_at = |place: usize| bytes.get(place..).is_some_and(|rest| rest.starts_with(MAGIC));
        if let Some(preamble_bytes) = [PREAMBLE_BYTES, 0].into_iter().find(|&place| is_magic_at(place)) {
            return Some(Self::Whole { preamble_bytes });
        }
        if bytes.starts_with(META_START) {
            return Some(Self::Meta);
        }
        let [group @ .., element, page, a, b, c, d] = *bytes.first_chunk::<8>()?;
        if group != FIRST_GROUP || page != 0 || element > LAST_FIRST_ELEMENT {
            return None;
        }
        if FIRST_TYPES.contains(&&[a, b][..]) {
            return Some(Self::Elements { syntax: uids::EXPLICIT_VR_LITTLE_ENDIAN });
        }
        let length = u32::from_le_bytes([a, b, c, d]);
        let is_believed = length <= LONGEST_FIRST_VALUE && length.is_multiple_of(2);
        is_believed.then_some(Self::Elements { syntax: uids::IMPLICIT_VR_LITTLE_ENDIAN })
    }

    /// How a file begins; None if it is no DICOM file.
    pub fn of_file(path: &Path) -> Result<Option<Self>, VolumeError> {
        let mut bytes = Vec::new();
        let file = open_file(path).map_err(VolumeError::open(path))?;
        let magic_bytes = (PREAMBLE_BYTES + MAGIC.len()) as u64;
        file.take(magic_bytes).read_to_end(&mut bytes).map_err(VolumeError::read(path))?;
        Ok(Self::of(&bytes))
    }

    /// What the parser wants to see before a file, and the file does not have.
    fn missing(self) -> Vec<u8> {
        match self {
            Self::Whole { .. } => Vec::new(),
            Self::Meta => MAGIC.to_vec(),
            Self::Elements { syntax } => {
                // The parser misses the first two aloud: what class and instance of image it is.
                let elements =
                    [(2, ""), (3, ""), (0x10, syntax)].map(|(place, uid)| identifier(place, uid)).concat();
                [MAGIC, META_START, &(elements.len() as u32).to_le_bytes(), &elements].concat()
            }
        }
    }

    /// A file with all that the parser wants to see.
    pub fn open(self, path: &Path) -> std::io::Result<Chain<Cursor<Vec<u8>>, File>> {
        Ok(Cursor::new(self.missing()).chain(open_file(path)?))
    }
}

/// An element of a meta group whose value is an identifier, filled up to an even length.
fn identifier(element: u8, uid: &str) -> Vec<u8> {
    let length = uid.len().next_multiple_of(2);
    let mut bytes = [&[2, 0, element, 0, b'U', b'I', length as u8, 0], uid.as_bytes()].concat();
    bytes.resize(8 + length, 0);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_elements_can_begin_with_is_believed() {
        assert_eq!(Start::of(b"DICM"), Some(Start::Whole { preamble_bytes: 0 }));
        assert_eq!(Start::of(b"\x02\0\0\0UL\x04\0"), Some(Start::Meta));
        let explicit = Start::Elements { syntax: uids::EXPLICIT_VR_LITTLE_ENDIAN };
        assert_eq!(Start::of(b"\x08\0\x05\0CS\x0a\0"), Some(explicit));
        let implicit = Start::Elements { syntax: uids::IMPLICIT_VR_LITTLE_ENDIAN };
        assert_eq!(Start::of(b"\x08\0\0\0\x04\0\0\0"), Some(implicit));
        for other in [
            "",
            "\x08\0\x05\0CS\x0a",
            "\x08\0\x05\0\x0b\0\0\0",
            "\x08\0\x05\0\0\0\0\x01",
            "\x08\0\x60\0CS\x02\0",
        ] {
            assert_eq!(Start::of(other.as_bytes()), None, "{other:?}");
        }
    }
}
