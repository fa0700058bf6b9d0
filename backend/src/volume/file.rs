//! A volume in a file, whatever its format: where the voxels lie, how they are packed, what their numbers mean.

use super::reader::{MAX_EDGE_VOXELS, VolumeInfo, VolumeReader};
use super::{ByteOrder, Element, VolumeError};
use flate2::read::{MultiGzDecoder, ZlibDecoder};
use glam::{DVec3, UVec3};
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
    pub voxel_size_m: DVec3,
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
    bytes: Vec<u8>,
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
            voxel_size_m: layout.voxel_size_m,
            element: layout.element,
            all_finite: !layout.element.is_float() && scaled_integers_fit_f32(&layout),
        };
        check_length(&layout, &info)?;
        let bytes = vec![0; info.slab_voxels() * layout.element.bytes()];
        let stream = stream(&layout, 0)?;
        Ok(Self { info, layout, stream, next_slab: 0, bytes })
    }

    /// Brings the stream to the first byte of slab `z`.
    fn go_to(&mut self, z: u32) -> Result<(), VolumeError> {
        if z == self.next_slab {
            return Ok(());
        }
        if self.layout.packing == Packing::Plain || z < self.next_slab {
            let skipped = if self.layout.packing == Packing::Plain { z } else { 0 };
            self.stream = stream(&self.layout, u64::from(skipped) * self.bytes.len() as u64)?;
            self.next_slab = skipped;
        }
        while self.next_slab < z {
            self.fill()?;
        }
        Ok(())
    }

    fn fill(&mut self) -> Result<(), VolumeError> {
        self.stream.read_exact(&mut self.bytes).map_err(|cause| self.read_error(cause))?;
        self.next_slab += 1;
        Ok(())
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

    fn read_slab(&mut self, z: u32, slab: &mut [f64]) -> Result<(), VolumeError> {
        assert!(z < self.info.dims.z && slab.len() == self.info.slab_voxels(), "slab {z} of {:?}", self.info);
        self.go_to(z)?;
        self.fill()?;
        self.layout.element.decode(self.layout.byte_order, &self.bytes, slab);
        let (slope, intercept) = (self.layout.slope, self.layout.intercept);
        if (slope, intercept) != (1.0, 0.0) {
            slab.iter_mut().for_each(|value| *value = *value * slope + intercept);
        }
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
    let (dims, size) = (layout.dims, layout.voxel_size_m);
    if dims.min_element() == 0 || dims.max_element() > MAX_EDGE_VOXELS {
        return wrong(format!("the dimensions are {dims}, and each must be from 1 to {MAX_EDGE_VOXELS}"));
    }
    if !size.is_finite() || size.min_element() <= 0.0 {
        return wrong(format!("the voxel size is {} mm, and each edge must be positive", size * 1e3));
    }
    if !layout.slope.is_finite() || !layout.intercept.is_finite() || layout.slope == 0.0 {
        return wrong(format!("values are scaled by {} and shifted by {}", layout.slope, layout.intercept));
    }
    Ok(())
}

/// Whether integers of up to 32 bits stay finite as f32 after scaling.
fn scaled_integers_fit_f32(layout: &FileLayout) -> bool {
    let largest = layout.slope.abs() * f64::from(u32::MAX) + layout.intercept.abs();
    largest < f64::from(f32::MAX)
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
