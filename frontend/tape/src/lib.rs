//! Everything that reached a world, on disk, as MCAP.
