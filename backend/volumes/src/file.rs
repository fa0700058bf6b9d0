//! A volume in a file, whatever its format: where the voxels lie, how they are packed, what their numbers mean.

use super::data_files::DataFiles;
use super::data_stream::{DataStream, Source, Start, StreamError, warn_of_more};
use super::packing::Packing;
use super::shape::Shape;
use bricks::volume::{ByteOrder, Element, Modality, Samples, VolumeError, VolumeFrame};
use bricks::volume::{VolumeInfo, VolumeReader};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Deflate cannot pack more than 1032 bytes into one (its longest match is 258 bytes in two bits).
const DEFLATE_LARGEST_RATIO: u64 = 1032;
/// Bytes read at once where only some of them are the volume's.
const PICK_BUFFER_BYTES: usize = 1 << 16;

/// What a format's header says; [`FileVolume::new`] checks it against the file.
#[derive(Clone, Debug)]
pub(super) struct FileLayout {
    /// The file the user named.
    pub header_path: PathBuf,
    /// The files with the voxels, all as long.
    pub files: DataFiles,
    /// What precedes the voxels in each of them.
    pub start: Start,
    pub shape: Shape,
    pub frame: VolumeFrame,
    pub modality: Modality,
    pub element: Element,
    pub byte_order: ByteOrder,
    pub packing: Packing,
    /// Value = slope × stored + intercept.
    pub slope: f64,
    pub intercept: f64,
}

/// An open volume file.
pub(super) struct FileVolume {
    info: VolumeInfo,
    shape: Shape,
    /// None if the numbers come in the order of this machine.
    byte_order: Option<ByteOrder>,
    stream: DataStream,
    /// Bytes of voxels in each file.
    file_bytes: u64,
    /// Numbers of which only some are the volume's.
    picked: Vec<u8>,
}

impl FileVolume {
    /// Checks the layout against the files' lengths before anything is allocated.
    pub fn new(layout: FileLayout) -> Result<Self, VolumeError> {
        check_numbers(&layout)?;
        let source = source(&layout)?;
        check_lengths(&source)?;
        let name =
            layout.header_path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let info = VolumeInfo {
            name,
            dims: layout.shape.dims,
            frame: layout.frame,
            modality: layout.modality,
            element: layout.element,
            slope: layout.slope,
            intercept: layout.intercept,
        };
        Ok(Self {
            info,
            shape: layout.shape,
            byte_order: (layout.packing != Packing::Text).then_some(layout.byte_order),
            file_bytes: source.file_bytes,
            stream: DataStream::new(source),
            picked: Vec::new(),
        })
    }

    /// Fills `slab` with the bytes of slab `z` as they are in the file.
    fn read_bytes(&mut self, z: u32, slab: &mut [u8]) -> Result<(), StreamError> {
        let bytes = self.info.element.bytes();
        let [x_stride, y_stride, z_stride] = self.shape.strides;
        let start = (self.shape.first + u64::from(z) * z_stride) * bytes as u64;
        if self.shape.has_dense_slabs() {
            return self.stream.read_at(start, slab);
        }
        let rows = slab.chunks_exact_mut(self.info.dims.x as usize * bytes);
        for (y, row) in rows.enumerate() {
            let start = start + y as u64 * y_stride * bytes as u64;
            match x_stride {
                1 => self.stream.read_at(start, row)?,
                _ => self.read_row(start, row)?,
            }
        }
        Ok(())
    }

    /// Fills `row` with numbers that do not follow each other: reads many and picks, or reads each where they lie far
    /// apart.
    fn read_row(&mut self, start: u64, row: &mut [u8]) -> Result<(), StreamError> {
        let bytes = self.info.element.bytes();
        let stride = self.shape.strides[0] as usize * bytes;
        let most = (PICK_BUFFER_BYTES / stride).max(1);
        for (number, voxels) in row.chunks_mut(most * bytes).enumerate() {
            let count = voxels.len() / bytes;
            self.picked.resize((count - 1) * stride + bytes, 0);
            self.stream.read_at(start + (number * most * stride) as u64, &mut self.picked)?;
            for (voxel, found) in voxels.chunks_exact_mut(bytes).zip(self.picked.chunks(stride)) {
                voxel.copy_from_slice(&found[..bytes]);
            }
        }
        Ok(())
    }

    fn read_error(&self, z: u32, error: StreamError) -> VolumeError {
        let StreamError { path, cause } = error;
        match cause.kind() {
            ErrorKind::UnexpectedEof => VolumeError::Truncated {
                path,
                promised: self.file_bytes,
                found: format!("the data end in slab {} of {}", z + 1, self.info.dims.z),
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
        self.read_bytes(z, slab.bytes_mut()).map_err(|error| self.read_error(z, error))?;
        if z + 1 == self.info.dims.z {
            self.stream.finish().map_err(|StreamError { path, cause }| VolumeError::Read { path, cause })?;
        }
        if let Some(order) = self.byte_order {
            slab.reorder(order);
        }
        Ok(())
    }
}

fn source(layout: &FileLayout) -> Result<Source, VolumeError> {
    let bytes = layout.shape.numbers * layout.element.bytes() as u64;
    let files = layout.files.len() as u64;
    if files == 0 || !layout.shape.numbers.is_multiple_of(files) {
        let what = format!("its {} voxels cannot lie in {files} files", layout.shape.numbers);
        return Err(VolumeError::header(&layout.header_path, what));
    }
    Ok(Source {
        files: layout.files.clone(),
        start: layout.start,
        packing: layout.packing,
        element: layout.element,
        file_bytes: bytes / files,
    })
}

fn check_numbers(layout: &FileLayout) -> Result<(), VolumeError> {
    let wrong = |what| Err(VolumeError::header(&layout.header_path, what));
    let size = layout.frame.voxel_size_m();
    if !VolumeFrame::of_voxels(size).is_sound() {
        return wrong(format!("the voxel size is {} mm, and {}", size * 1e3, VolumeFrame::SOUND_EDGES));
    }
    if !layout.frame.is_sound() {
        return wrong("its axes lie in a plane, or its origin is not a number".into());
    }
    if !layout.slope.is_finite() || !layout.intercept.is_finite() || layout.slope == 0.0 {
        return wrong(format!("values are scaled by {} and shifted by {}", layout.slope, layout.intercept));
    }
    Ok(())
}

/// Every file must be there, and long enough for its voxels.
fn check_lengths(source: &Source) -> Result<(), VolumeError> {
    for path in (0..source.files.len()).map(|index| source.files.path(index)) {
        let length = file_length(&path)?;
        let offset = source.offset(&path).map_err(VolumeError::read(&path))?;
        check_length(source, &path, length.saturating_sub(offset))?;
    }
    Ok(())
}

/// Whether the `found` bytes of a file can be its voxels.
fn check_length(source: &Source, path: &Path, found: u64) -> Result<(), VolumeError> {
    let promised = source.file_bytes;
    let (most, found) = match source.packing {
        Packing::Plain => {
            let found = found.saturating_sub(source.start.unpacked_bytes);
            warn_of_more(path, found, promised);
            (found, format!("{found} are there"))
        }
        Packing::Gzip | Packing::Zlib => {
            (found.saturating_mul(DEFLATE_LARGEST_RATIO), format!("{found} packed bytes cannot hold them"))
        }
        // A number has a digit at least, and a blank before the next.
        Packing::Text => (
            found.div_ceil(2).saturating_mul(source.element.bytes() as u64),
            format!("{found} characters cannot hold them"),
        ),
    };
    if most >= promised {
        return Ok(());
    }
    Err(VolumeError::Truncated { path: path.into(), promised, found })
}

/// Length of a file in bytes.
pub(super) fn file_length(path: &Path) -> Result<u64, VolumeError> {
    let metadata = std::fs::metadata(path).map_err(VolumeError::open(path))?;
    if metadata.is_dir() {
        return Err(VolumeError::unsupported(path, "it is a folder: give the file in it"));
    }
    if !metadata.is_file() {
        return Err(VolumeError::unsupported(path, "it is a pipe or a device: save it as a file first"));
    }
    Ok(metadata.len())
}
