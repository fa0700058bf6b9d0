//! How many bricks a cache holds.

/// Slots for the bricks that fit, at least the nine that show a root and its children, and a blank one.
pub(crate) fn slots_within(cache_bytes: u64, brick_bytes: u64, slots_needed: u64) -> u32 {
    slots_needed.min(cache_bytes / brick_bytes).clamp(9, 1 << 20) as u32 + 1
}
