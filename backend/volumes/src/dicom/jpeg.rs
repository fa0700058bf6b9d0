//! What a JPEG says of its own size, before it is unpacked.

/// Bytes before the marker of a segment.
const MARK: u8 = 0xff;
const START_OF_IMAGE: [u8; 2] = [MARK, 0xd8];
const START_OF_SCAN: u8 = 0xda;

/// The size of a JPEG (ITU T.81, B.2.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct JpegSize {
    pub rows: u32,
    pub columns: u32,
    /// Numbers per pixel.
    pub components: u32,
    /// Bits of a number.
    pub bits: u32,
}

impl JpegSize {
    /// The size in the frame header; None where these bytes do not begin a JPEG, or have no such header.
    pub fn of(jpeg: &[u8]) -> Option<Self> {
        let mut rest = jpeg.strip_prefix(&START_OF_IMAGE)?;
        loop {
            let at = rest.iter().position(|&byte| byte != MARK)?;
            let (marker, segment) = (rest[at], &rest[at + 1..]);
            let is_marked = at > 0;
            if !is_marked || marker == START_OF_SCAN {
                return None;
            }
            // Tables and restarts have markers between those of frames, and so do extensions.
            if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
                return Self::in_segment(segment);
            }
            let has_length = !matches!(marker, 0x01 | 0xd0..=0xd9);
            rest = if has_length { segment.get(usize::from(u16_at(segment, 0)?)..)? } else { segment };
        }
    }

    /// Length, precision, lines, samples per line, components.
    fn in_segment(segment: &[u8]) -> Option<Self> {
        Some(Self {
            bits: (*segment.get(2)?).into(),
            rows: u16_at(segment, 3)?.into(),
            columns: u16_at(segment, 5)?.into(),
            components: (*segment.get(7)?).into(),
        })
    }

    /// Bytes that it unpacks to.
    pub fn bytes(self) -> u64 {
        let pixels = u64::from(self.rows) * u64::from(self.columns);
        pixels * u64::from(self.components) * u64::from(self.bits.div_ceil(8))
    }
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes([*bytes.get(at)?, *bytes.get(at + 1)?]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_header_is_found_behind_others() {
        let application = [0xff, 0xe0, 0, 4, 1, 2];
        let tables = [0xff, 0xc4, 0, 3, 9];
        let frame = [0xff, 0xff, 0xc3, 0, 11, 16, 0, 20, 1, 4, 1];
        let jpeg = [&START_OF_IMAGE[..], &application, &tables, &frame].concat();
        let size = JpegSize { rows: 20, columns: 260, components: 1, bits: 16 };
        assert_eq!(JpegSize::of(&jpeg), Some(size));
        assert_eq!(size.bytes(), 20 * 260 * 2);
        assert!((0..jpeg.len()).all(|length| JpegSize::of(&jpeg[..length]).is_none()));
        assert_eq!(JpegSize::of(&[&START_OF_IMAGE[..], &[0xff, START_OF_SCAN, 0, 2]].concat()), None);
    }
}
