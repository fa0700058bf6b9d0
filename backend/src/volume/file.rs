//! A volume in a file, whatever its format: where the voxels lie, how they are packed, what their numbers mean.

use super::reader::{MAX_EDGE_VOXELS, VolumeInfo, VolumeReader};
use super::{ByteOrder, Element, Samples, VolumeError, VolumeFrame};
use flate2::read::{MultiGzDecoder, ZlibDecoder};
use glam::UVec3;
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Deflate cannot pack more than 1032 bytes into one (its longest match is 258 bytes in two bits).
const DEFLATE_LARGEST_RATIO: u64 = 1032;
/// Bytes read from the file at once.
const READ_BUFFER_BYTES: usize = 1 << 18;

/// How the voxels are packed in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    Plain,
    Gzip,
    Zlib,
}

/// What a format's header says; [`FileVolume::new`] checks it against the file.
#[derive(Clone, Debug)]
pub(super) struct FileLayout {
    /// The file the user named.
    pub header_path: PathBuf,
    /// The file with the voxels.
    pub data_path: PathBuf,
    pub dims: UVec3,
    pub frame: VolumeFrame,
    pub element: Element,
    pub byte_order: ByteOrder,
    pub packing: Packing,
    /// Bytes of the file before the (packed) data.
    pub file_offset: u64,
    /// Bytes of the unpacked data before the first voxel.
    pub data_offset: u64,
    /// Value = slope × stored + intercept.
    pub slope: f64,
    pub intercept: f64,
}

/// An open volume file.
pub(super) struct FileVolume {
    info: VolumeInfo,
    layout: FileLayout,
    stream: Box<dyn Read + Send>,
    next_slab: u32,
}

impl FileVolume {
    /// Checks the layout against the file's length before anything is allocated.
    pub fn new(layout: FileLayout) -> Result<Self, VolumeError> {
        check_numbers(&layout)?;
        let name =
            layout.header_path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let info = VolumeInfo {
            name,
            dims: layout.dims,
            frame: layout.frame,
            element: layout.element,
            slope: layout.slope,
            intercept: layout.intercept,
        };
        check_length(&layout, &info)?;
        let stream = stream(&layout, 0)?;
        Ok(Self { info, layout, stream, next_slab: 0 })
    }

    /// Brings the stream to the first byte of slab `z`.
    fn go_to(&mut self, z: u32) -> Result<(), VolumeError> {
        if z == self.next_slab {
            return Ok(());
        }
        if self.layout.packing == Packing::Plain || z < self.next_slab {
            let skipped = if self.layout.packing == Packing::Plain { z } else { 0 };
            self.stream = stream(&self.layout, u64::from(skipped) * self.slab_bytes())?;
            self.next_slab = skipped;
        }
        let bytes = u64::from(z - self.next_slab) * self.slab_bytes();
        let skipped = std::io::copy(&mut self.stream.by_ref().take(bytes), &mut std::io::sink());
        match skipped {
            Ok(skipped) if skipped == bytes => self.next_slab = z,
            Ok(_) => return Err(self.read_error(ErrorKind::UnexpectedEof.into())),
            Err(cause) => return Err(self.read_error(cause)),
        }
        Ok(())
    }

    fn slab_bytes(&self) -> u64 {
        self.info.slab_voxels() as u64 * self.layout.element.bytes() as u64
    }

    fn read_error(&self, cause: std::io::Error) -> VolumeError {
        let path = self.layout.data_path.clone();
        match cause.kind() {
            ErrorKind::UnexpectedEof => VolumeError::Truncated {
                path,
                promised: self.info.bytes(),
                found: format!("the data end in slab {} of {}", self.next_slab + 1, self.info.dims.z),
            },
            _ => VolumeError::Read { path, cause },
        }
    }
}

impl VolumeReader for FileVolume {
    fn info(&self) -> &VolumeInfo {
        &self.info
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        assert!(z < self.info.dims.z && slab.len() == self.info.slab_voxels(), "slab {z} of {:?}", self.info);
        self.go_to(z)?;
        self.stream.read_exact(slab.bytes_mut()).map_err(|cause| self.read_error(cause))?;
        self.next_slab += 1;
        slab.reorder(self.layout.byte_order);
        Ok(())
    }
}

/// The voxels' bytes from `start` (plain files only; packed ones start at 0).
fn stream(layout: &FileLayout, start: u64) -> Result<Box<dyn Read + Send>, VolumeError> {
    let path = &layout.data_path;
    let mut file = File::open(path).map_err(VolumeError::open(path))?;
    let plain_start = if layout.packing == Packing::Plain { layout.data_offset + start } else { 0 };
    file.seek(SeekFrom::Start(layout.file_offset + plain_start)).map_err(VolumeError::read(path))?;
    let file = BufReader::with_capacity(READ_BUFFER_BYTES, file);
    let mut unpacked: Box<dyn Read + Send> = match layout.packing {
        Packing::Plain => return Ok(Box::new(file)),
        Packing::Gzip => Box::new(MultiGzDecoder::new(file)),
        Packing::Zlib => Box::new(ZlibDecoder::new(file)),
    };
    let skip = &mut unpacked.by_ref().take(layout.data_offset);
    std::io::copy(skip, &mut std::io::sink()).map_err(VolumeError::read(path))?;
    Ok(unpacked)
}

fn check_numbers(layout: &FileLayout) -> Result<(), VolumeError> {
    let wrong = |what| Err(VolumeError::header(&layout.header_path, what));
    let (dims, size) = (layout.dims, layout.frame.voxel_size_m());
    if dims.min_element() == 0 || dims.max_element() > MAX_EDGE_VOXELS {
        return wrong(format!("the dimensions are {dims}, and each must be from 1 to {MAX_EDGE_VOXELS}"));
    }
    if !size.is_finite() || size.min_element() <= 0.0 {
        return wrong(format!("the voxel size is {} mm, and each edge must be positive", size * 1e3));
    }
    if !layout.frame.is_sound() {
        return wrong("its axes lie in a plane, or its origin is no number".into());
    }
    if !layout.slope.is_finite() || !layout.intercept.is_finite() || layout.slope == 0.0 {
        return wrong(format!("values are scaled by {} and shifted by {}", layout.slope, layout.intercept));
    }
    Ok(())
}

fn check_length(layout: &FileLayout, info: &VolumeInfo) -> Result<(), VolumeError> {
    let length = file_length(&layout.data_path)?;
    let found = length.saturating_sub(layout.file_offset);
    let promised = info.bytes();
    let (enough, found) = match layout.packing {
        Packing::Plain => {
            let found = found.saturating_sub(layout.data_offset);
            if found > promised {
                tracing::warn!(path = %layout.data_path.display(), found, promised, "more bytes than the header says");
            }
            (found >= promised, format!("{found} are there"))
        }
        Packing::Gzip | Packing::Zlib => (
            found.saturating_mul(DEFLATE_LARGEST_RATIO) >= promised,
            format!("{found} packed bytes cannot hold them"),
        ),
    };
    if enough {
        return Ok(());
    }
    Err(VolumeError::Truncated { path: layout.data_path.clone(), promised, found })
}

/// Length of a file in bytes.
pub(super) fn file_length(path: &Path) -> Result<u64, VolumeError> {
    let metadata = std::fs::metadata(path).map_err(VolumeError::open(path))?;
    if metadata.is_dir() {
        return Err(VolumeError::unsupported(path, "it is a folder: give the file in it"));
    }
    Ok(metadata.len())
}
