//! Which volume of those in a file, and what the file itself does not say.

use super::RawLayout;
use glam::DVec3;

/// What a user says beside the path: which volume of those in it, and what the files themselves do not say.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// A file without header holds this.
    pub raw: Option<RawLayout>,
    /// Of a folder with several DICOM series: its number in the list (from 1), or how its UID starts or ends; of a
    /// folder with several OME-Zarr images: its number, or its folder's name.
    pub series: Option<String>,
    /// Of a pyramid: the level, 0 = finest; None is 0.
    pub level: Option<u32>,
    /// Of several channels, samples per pixel, or volumes in one file: which one, from 0. None is right only where
    /// there is one.
    pub channel: Option<u32>,
    /// Of a time series: which point in time, from 0. None is right only if there is one.
    pub time: Option<u32>,
    /// Edges of a voxel in millimetres, instead of what the file says.
    pub spacing_mm: Option<DVec3>,
    /// Memory that a reader may use for what it has decoded and not yet handed out, bytes.
    pub memory_bytes: u64,
}

impl Default for Selection {
    fn default() -> Self {
        Self {
            raw: None,
            series: None,
            level: None,
            channel: None,
            time: None,
            spacing_mm: None,
            memory_bytes: 256 << 20,
        }
    }
}
