//! DICOM's run-length packing (PS3.5 annex G).

/// Bytes of the header: the number of segments, and 15 places where they begin.
const HEADER_BYTES: usize = 64;
const MOST_SEGMENTS: usize = 15;

/// The cells of a frame, lowest byte first: `pixels` of `cell_bytes` each. None if the data are damaged.
///
/// Each segment holds one byte of every cell, the highest first.
pub(super) fn unpack(packed: &[u8], pixels: usize, cell_bytes: usize) -> Option<Vec<u8>> {
    let header = packed.get(..HEADER_BYTES)?;
    let word = |at: usize| u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    let segments = word(0) as usize;
    if segments != cell_bytes || segments > MOST_SEGMENTS {
        return None;
    }
    let start = |segment: usize| word(4 + 4 * segment) as usize;
    let mut cells = vec![0; pixels * cell_bytes];
    for segment in 0..segments {
        let end = if segment + 1 < segments { start(segment + 1) } else { packed.len() };
        let places = cells[cell_bytes - 1 - segment..].iter_mut().step_by(cell_bytes);
        unpack_segment(packed.get(start(segment)..end)?, places)?;
    }
    Some(cells)
}

/// Fills all places from a segment: a byte below 128 says that so many and one follow, one above 128 that the
/// next is repeated 257 less so many times.
fn unpack_segment<'a>(
    mut packed: &[u8],
    mut places: impl ExactSizeIterator<Item = &'a mut u8>,
) -> Option<()> {
    while places.len() > 0 {
        let (&control, rest) = packed.split_first()?;
        let control = usize::from(control);
        let taken = match control {
            0..128 => control + 1,
            128 => 0,
            _ => 1,
        };
        let (run, rest) = rest.split_at_checked(taken)?;
        match control {
            0..=128 => places.by_ref().zip(run).for_each(|(place, &byte)| *place = byte),
            _ => places.by_ref().take(257 - control).for_each(|place| *place = run[0]),
        }
        packed = rest;
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packed(segments: &[&[u8]]) -> Vec<u8> {
        let mut packed = vec![0; HEADER_BYTES];
        packed[0] = segments.len() as u8;
        for (i, segment) in segments.iter().enumerate() {
            packed[4 + 4 * i] = packed.len() as u8;
            packed.extend_from_slice(segment);
        }
        packed
    }

    #[test]
    fn runs_and_copies_interleave_to_cells() {
        let packed = packed(&[&[254, 1], &[2, 10, 11, 12]]);
        assert_eq!(unpack(&packed, 3, 2), Some(vec![10, 1, 11, 1, 12, 1]));
    }

    #[test]
    fn damage_is_noticed() {
        let packed = packed(&[&[254, 1], &[2, 10, 11, 12]]);
        assert!((0..packed.len()).all(|length| unpack(&packed[..length], 3, 2).is_none()));
        assert_eq!(unpack(&packed, 4, 2), None);
        assert_eq!(unpack(&packed, 3, 1), None);
    }
}
