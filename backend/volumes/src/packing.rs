//! How voxels are packed in a file.

/// How the voxels are packed in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    Plain,
    Gzip,
    Zlib,
    /// Written as decimal numbers.
    Text,
}
