//! Whether two frames are the same.

use crate::FrontendError;
use protocol::wire::encode;
use protocol::{FrameState, FromFrontend};

/// The parameters of FNV-1a with 64 bits (Fowler, Noll and Vo).
const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

/// A number that differs, but for chance, where two frames differ in anything that their pictures depend on.
///
/// # Errors
/// The frame does not become bytes.
pub fn check_number(frame: &FrameState) -> Result<u64, FrontendError> {
    // Which caster is welcome depends on how fast back-ends are.
    let frame = FrameState { welcomes_planes: false, ..frame.clone() };
    let bytes = encode(&FromFrontend::Frame(Box::new(frame)))
        .map_err(|error| FrontendError::Backend(error.to_string()))?;
    Ok(bytes.iter().fold(BASIS, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME)))
}
