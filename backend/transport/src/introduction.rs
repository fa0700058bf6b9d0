//! The first message between two ranks: role (1 byte), process number (4 bytes, little-endian), host name (the rest).
//!
//! It says which rank claims to be what before anything waits, and whose process to look for later.

use super::launch::HOW_TO_LAUNCH;
use super::link::LinkError;
use super::mpi::Messenger;
use super::pause::Pause;
use super::process;
use super::roster::Peer;
use std::sync::Arc;
use std::time::{Duration, Instant};

pub const FRONTEND_RANK: usize = 0;
pub const IS_FRONTEND: u8 = 1;
pub const IS_BACKEND: u8 = 2;

/// How long the introductions may take; the launcher may start the ranks one after another.
const INTRODUCTIONS: Duration = Duration::from_secs(60);

/// What a rank says of itself.
pub fn introduction(role: u8) -> Arc<[u8]> {
    let mut bytes = vec![role];
    bytes.extend(std::process::id().to_le_bytes());
    bytes.extend(process::host().as_bytes());
    bytes.into()
}

/// Role and peer of the rank that introduces itself next.
///
/// # Errors
/// It does not, or is no lightloom: a sentence to end with.
pub fn await_introduction(messenger: &mut Messenger, rank: usize) -> Result<(u8, Peer), LinkError> {
    let since = Instant::now();
    let mut pause = Pause::default();
    while since.elapsed() < INTRODUCTIONS {
        if let Some(bytes) = messenger.poll(rank).map_err(LinkError::Launch)? {
            return read_introduction(rank, &bytes).ok_or_else(|| {
                LinkError::Launch(format!(
                    "rank {rank} does not run lightloom; start the job with `{HOW_TO_LAUNCH}`"
                ))
            });
        }
        pause.wait(messenger.is_moving());
    }
    let seconds = INTRODUCTIONS.as_secs();
    Err(LinkError::Launch(format!(
        "rank {rank} has not introduced itself in {seconds} s; see whether it started"
    )))
}

fn read_introduction(rank: usize, bytes: &[u8]) -> Option<(u8, Peer)> {
    let (&role, rest) = bytes.split_first()?;
    let (process, host) = rest.split_first_chunk()?;
    let host = std::str::from_utf8(host).ok()?.to_owned();
    Some((role, Peer::new(rank, host, u32::from_le_bytes(*process))))
}
