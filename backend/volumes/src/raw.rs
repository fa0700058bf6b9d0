//! Raw voxels without a header: the user says what they are.

use super::data_files::DataFiles;
use super::data_stream::Start;
use super::file::{FileLayout, file_length};
use super::packing::Packing;
use super::shape::Shape;
use bricks::volume::{ByteOrder, Element, Modality, VolumeError, VolumeFrame};
use glam::{DVec3, UVec3};
use std::path::Path;

/// What a raw file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct RawLayout {
    /// Voxels along x (fastest), y, z.
    pub dims: UVec3,
    /// Type of a voxel.
    pub element: Element,
    /// Byte order of a voxel.
    pub byte_order: ByteOrder,
    /// Edge lengths of a voxel in millimetres.
    pub spacing_mm: DVec3,
    /// Bytes before the first voxel.
    pub header_skip_bytes: u64,
}

/// A raw file must be exactly as long as the layout says: nothing else can distinguish a wrong layout from a right one.
pub(super) fn layout(path: &Path, raw: &RawLayout) -> Result<FileLayout, VolumeError> {
    let found = file_length(path)?.saturating_sub(raw.header_skip_bytes);
    let voxels: u128 = raw.dims.to_array().map(u128::from).iter().product();
    let promised = voxels.saturating_mul(raw.element.bytes() as u128);
    if promised != u128::from(found) {
        return Err(VolumeError::RawSize {
            path: path.into(),
            found,
            skip: raw.header_skip_bytes,
            what: format!("{} × {} × {} voxels of {}", raw.dims.x, raw.dims.y, raw.dims.z, raw.element),
            promised: u64::try_from(promised).unwrap_or(u64::MAX),
        });
    }
    let shape = Shape::of_volume(raw.dims.to_array().map(i64::from))
        .map_err(|what| VolumeError::header(path, what))?;
    Ok(FileLayout {
        header_path: path.into(),
        files: DataFiles::One(path.into()),
        start: Start { header_bytes: raw.header_skip_bytes, ..Start::default() },
        shape,
        frame: VolumeFrame::of_voxels(raw.spacing_mm * 1e-3),
        modality: Modality::Unknown,
        element: raw.element,
        byte_order: raw.byte_order,
        packing: Packing::Plain,
        slope: 1.0,
        intercept: 0.0,
    })
}
