//! How many bricks may be on their way.

use super::SAMPLE_BYTES;

/// Bricks whose samples may be on their way, in frames' worth of uploads: enough to keep a disk busy, few enough that
/// what was asked for is still wanted when it comes.
const FRAMES_IN_FLIGHT: u64 = 4;
/// The same at least.
const LEAST_IN_FLIGHT: u64 = 64;

/// Bricks that may be asked for and not be there yet, where a frame may upload so many bytes.
pub fn most_in_flight(upload_bytes: u64) -> usize {
    (FRAMES_IN_FLIGHT.saturating_mul(upload_bytes) / SAMPLE_BYTES).max(LEAST_IN_FLIGHT) as usize
}
