//! NIfTI-1 headers (.nii, .nii.gz): 348 bytes, byte order told by the first number.

use super::file::{FileLayout, Packing};
use super::{ByteOrder, Element, VolumeError, VolumeFrame};
use flate2::read::MultiGzDecoder;
use glam::{DVec3, UVec3};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

// Offsets of the fields used here, in bytes (nifti1.h of the NIfTI-1.1 standard).
const HEADER_BYTES: usize = 348;
const DIM: usize = 40;
const DATATYPE: usize = 70;
const PIXDIM: usize = 76;
const VOX_OFFSET: usize = 108;
const SCL_SLOPE: usize = 112;
const SCL_INTER: usize = 116;
const XYZT_UNITS: usize = 123;
const MAGIC: usize = 344;
/// Voxels of a single-file volume start here at the earliest: header and extension flag.
const EARLIEST_VOXELS: u64 = 352;
/// Size of the header of a NIfTI-2 file, which tells it.
const NIFTI2_HEADER_BYTES: i32 = 540;

/// Whether the bytes start as a NIfTI file does.
pub(super) fn is_header(start: &[u8]) -> bool {
    start.len() >= HEADER_BYTES && matches!(&start[MAGIC..HEADER_BYTES], b"n+1\0" | b"ni1\0")
}

/// Reads the header.
pub(super) fn layout(path: &Path) -> Result<FileLayout, VolumeError> {
    let (bytes, packing) = read_header(path)?;
    let header = Header { path, byte_order: byte_order(path, &bytes)?, bytes };
    if &header.bytes[MAGIC..] != b"n+1\0" {
        let what = "it is not a single NIfTI-1 file (magic n+1): save header and voxels together as .nii";
        return Err(VolumeError::unsupported(path, what));
    }
    let (slope, intercept) = header.scaling();
    Ok(FileLayout {
        header_path: path.into(),
        data_path: path.into(),
        dims: header.dims()?,
        frame: VolumeFrame::of_voxels(header.voxel_size_m()?),
        element: header.element()?,
        byte_order: header.byte_order,
        packing,
        file_offset: 0,
        data_offset: header.voxels_offset()?,
        slope,
        intercept,
    })
}

fn read_header(path: &Path) -> Result<([u8; HEADER_BYTES], Packing), VolumeError> {
    let mut bytes = [0; HEADER_BYTES];
    let mut open = |packing| {
        let file = File::open(path).map_err(VolumeError::open(path))?;
        let mut stream: Box<dyn Read> = match packing {
            Packing::Plain | Packing::Zlib => Box::new(file),
            Packing::Gzip => Box::new(MultiGzDecoder::new(file)),
        };
        stream.read_exact(&mut bytes).map_err(|cause| match cause.kind() {
            ErrorKind::UnexpectedEof => {
                VolumeError::header(path, "a NIfTI header has 348 bytes, and the file ends before")
            }
            _ => VolumeError::Read { path: path.into(), cause },
        })?;
        Ok(bytes)
    };
    let mut magic = [0; 2];
    let mut file = File::open(path).map_err(VolumeError::open(path))?;
    let packed = file.read_exact(&mut magic).is_ok() && magic == [0x1f, 0x8b];
    let packing = if packed { Packing::Gzip } else { Packing::Plain };
    Ok((open(packing)?, packing))
}

fn byte_order(path: &Path, bytes: &[u8; HEADER_BYTES]) -> Result<ByteOrder, VolumeError> {
    let size = [bytes[0], bytes[1], bytes[2], bytes[3]];
    match (i32::from_le_bytes(size), i32::from_be_bytes(size)) {
        (348, _) => Ok(ByteOrder::Little),
        (_, 348) => Ok(ByteOrder::Big),
        (NIFTI2_HEADER_BYTES, _) | (_, NIFTI2_HEADER_BYTES) => {
            Err(VolumeError::unsupported(path, "it is a NIfTI-2 file: save it as NIfTI-1"))
        }
        (found, _) => {
            Err(VolumeError::header(path, format!("a NIfTI file starts with 348, and this one with {found}")))
        }
    }
}

struct Header<'a> {
    path: &'a Path,
    bytes: [u8; HEADER_BYTES],
    byte_order: ByteOrder,
}

impl Header<'_> {
    fn i16(&self, offset: usize) -> i16 {
        let stored = [self.bytes[offset], self.bytes[offset + 1]];
        match self.byte_order {
            ByteOrder::Little => i16::from_le_bytes(stored),
            ByteOrder::Big => i16::from_be_bytes(stored),
        }
    }

    fn f32(&self, offset: usize) -> f32 {
        let stored = [0, 1, 2, 3].map(|i| self.bytes[offset + i]);
        match self.byte_order {
            ByteOrder::Little => f32::from_le_bytes(stored),
            ByteOrder::Big => f32::from_be_bytes(stored),
        }
    }

    fn dims(&self) -> Result<UVec3, VolumeError> {
        let axes = self.i16(DIM);
        if !(1..=7).contains(&axes) {
            return Err(VolumeError::header(
                self.path,
                format!("it claims {axes} axes, and 1 to 7 are possible"),
            ));
        }
        let edge = |axis: i16| if axis <= axes { i32::from(self.i16(DIM + 2 * axis as usize)) } else { 1 };
        if let Some(axis) = (4..=axes).find(|&axis| edge(axis) > 1) {
            let what = format!("it holds {} volumes (axis {axis}): save one of them", edge(axis));
            return Err(VolumeError::unsupported(self.path, what));
        }
        let edges = [edge(1), edge(2), edge(3)];
        if edges.iter().any(|&n| n < 1) {
            return Err(VolumeError::header(
                self.path,
                format!("the dimensions are {edges:?}, and each must be at least 1"),
            ));
        }
        Ok(UVec3::from_array(edges.map(|n| n as u32)))
    }

    /// Edge lengths; an unknown unit is taken for millimetres and an unknown length for one of them.
    fn voxel_size_m(&self) -> Result<DVec3, VolumeError> {
        let unit_m = match self.bytes[XYZT_UNITS] & 7 {
            0 | 2 => 1e-3,
            1 => 1.0,
            3 => 1e-6,
            code => {
                return Err(VolumeError::header(
                    self.path,
                    format!("its unit of length has the unknown code {code}"),
                ));
            }
        };
        let edge = |axis: usize| match f64::from(self.f32(PIXDIM + 4 * axis)).abs() {
            0.0 => 1.0,
            length => length,
        };
        Ok(DVec3::new(edge(1), edge(2), edge(3)) * unit_m)
    }

    fn element(&self) -> Result<Element, VolumeError> {
        Ok(match self.i16(DATATYPE) {
            2 => Element::U8,
            4 => Element::I16,
            8 => Element::I32,
            16 => Element::F32,
            64 => Element::F64,
            256 => Element::I8,
            512 => Element::U16,
            768 => Element::U32,
            code => {
                let what =
                    format!("its data type {code} is not supported: save it as 16-bit integers or floats");
                return Err(VolumeError::unsupported(self.path, what));
            }
        })
    }

    fn voxels_offset(&self) -> Result<u64, VolumeError> {
        let offset = self.f32(VOX_OFFSET);
        if !(0.0..=1e9).contains(&offset) {
            return Err(VolumeError::header(
                self.path,
                format!("its voxels are said to start at byte {offset}"),
            ));
        }
        Ok((offset as u64).max(EARLIEST_VOXELS))
    }

    /// Slope and intercept; the standard says that a slope of zero, or none that is a number, means no scaling.
    fn scaling(&self) -> (f64, f64) {
        let (slope, intercept) = (f64::from(self.f32(SCL_SLOPE)), f64::from(self.f32(SCL_INTER)));
        match slope == 0.0 || !slope.is_finite() {
            true => (1.0, 0.0),
            false => (slope, if intercept.is_finite() { intercept } else { 0.0 }),
        }
    }
}
