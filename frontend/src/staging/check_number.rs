//! Whether two frames are the same.

use crate::FrontendError;
use protocol::wire::encode;
use protocol::{FrameState, FromFrontend, Pace};

/// The parameters of FNV-1a with 64 bits (Fowler, Noll and Vo).
const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

/// A number that differs, but for chance, where two frames show anything different. Their numbers, and how they get their
/// detail, are no part of it.
///
/// # Errors
/// The frame does not become bytes.
pub fn check_number(frame: &FrameState) -> Result<u64, FrontendError> {
    // What depends on how a show is driven, and not on what it shows.
    let (index, pace, sub_frame, welcomes_planes) = (0, Pace::Complete, None, false);
    let frame = FrameState { index, pace, sub_frame, welcomes_planes, ..frame.clone() };
    let bytes = encode(&FromFrontend::Frame(Box::new(frame)))
        .map_err(|error| FrontendError::Backend(error.to_string()))?;
    Ok(bytes.iter().fold(BASIS, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME)))
}
