//! Whether two frames are the same.

use crate::FrontendError;
use glam::{DAffine3, DVec3};
use optics::{Curve, Optics};
use protocol::wire::encode;
use protocol::{FrameState, FromFrontend, Mark, Pace};

/// The parameters of FNV-1a with 64 bits (Fowler, Noll and Vo).
const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

/// Frames count as this version of the protocol wrote them, so that a tape made since then can be compared by any later program.
/// What frames have got after it counts only where it is not as it was before.
const VERSION: u32 = 13;
/// Bytes of a message's header: its magic number, the version, and the length of what follows.
const MAGIC: usize = 4;
const HEADER: usize = 12;
/// Bytes of how many marks there are, which stand at the end of a frame.
const COUNT: usize = 8;

/// A number that differs, but for chance, where two frames show anything different. Their numbers, and how they get their
/// detail, are no part of it.
///
/// # Errors
/// The frame does not become bytes.
pub fn check_number(frame: &FrameState) -> Result<u64, FrontendError> {
    // What depends on how a show is driven, and not on what it shows.
    let (index, pace, sub_frame, welcomes_planes) = (0, Pace::Complete, None, false);
    let bare = FrameState { index, pace, sub_frame, welcomes_planes, marks: Vec::new(), ..frame.clone() };
    let bytes = bytes_of(&bare)?;
    let marks = mark_bytes(&frame.marks)?;
    let length = (bytes.len() - HEADER + marks.len()) as u32;
    let combined = frame.marks.iter().any(|mark| mark.is_depth_combined);
    let later = frame.marks.iter().map(|mark| u8::from(mark.is_depth_combined)).filter(|_| combined);
    let all = (bytes[..MAGIC].iter().copied())
        .chain(VERSION.to_le_bytes())
        .chain(length.to_le_bytes())
        .chain(bytes[HEADER..bytes.len() - COUNT].iter().copied())
        .chain((frame.marks.len() as u64).to_le_bytes())
        .chain(marks)
        .chain(later);
    Ok(all.fold(BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME)))
}

fn bytes_of(frame: &FrameState) -> Result<Vec<u8>, FrontendError> {
    encode(&FromFrontend::Frame(Box::new(frame.clone())))
        .map_err(|error| FrontendError::Backend(error.to_string()))
}

/// The bytes of marks, without the last of each, which says whether it is depth-combined: those that a frame gets by it. Any frame
/// will do, so it is a short one.
fn mark_bytes(marks: &[Mark]) -> Result<Vec<u8>, FrontendError> {
    let mut frame = FrameState::still(DVec3::Z, DAffine3::IDENTITY, Optics::grey(Curve::constant(0.0)));
    let bare = bytes_of(&frame)?.len();
    let mut all = Vec::new();
    for mark in marks {
        frame.marks = vec![mark.clone()];
        let with = bytes_of(&frame)?;
        all.extend(&with[bare..with.len() - 1]);
    }
    Ok(all)
}
