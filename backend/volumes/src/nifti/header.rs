//! The header of a NIfTI file: its bytes as numbers, whichever version and byte order.

use super::unpacked::reader;
use bricks::volume::{ByteOrder, VolumeError};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// Size of the header of NIfTI-1, and the first number in it.
const BYTES_1: usize = 348;
/// Size of the header of NIfTI-2, and the first number in it.
const BYTES_2: usize = 540;
const MAGIC_1: usize = 344;
const MAGIC_2: usize = 4;
/// Bytes that say whether extensions follow the header of a single file.
const EXTENSION_FLAG_BYTES: u64 = 4;

/// What is used of a header.
pub(super) struct Header {
    /// The file it was read from.
    pub path: PathBuf,
    pub byte_order: ByteOrder,
    /// Whether the voxels are in the same file.
    pub is_single: bool,
    /// Number of axes, then numbers along each.
    pub dim: [i64; 8],
    pub datatype: i16,
    /// The sign of the third axis (qfac), then lengths along each axis.
    pub pixdim: [f64; 8],
    pub vox_offset: f64,
    pub slope: f64,
    pub intercept: f64,
    pub units: i32,
    pub qform_code: i32,
    pub sform_code: i32,
    /// b, c, d of the rotation's quaternion.
    pub quaternion: [f64; 3],
    pub q_offset: [f64; 3],
    /// Rows of the affine map.
    pub s_rows: [[f64; 4]; 3],
    bytes: usize,
}

/// Whether the bytes start as a NIfTI file does.
pub(in super::super) fn is_header(start: &[u8]) -> bool {
    let magic = |at: usize| start.get(at..at + 4);
    matches!(magic(MAGIC_1), Some(b"n+1\0" | b"ni1\0")) || matches!(magic(MAGIC_2), Some(b"n+2\0" | b"ni2\0"))
}

impl Header {
    pub fn read(path: &Path) -> Result<Self, VolumeError> {
        let mut stream = reader(path)?;
        let mut bytes = vec![0; BYTES_1];
        read(path, &mut stream, &mut bytes)?;
        let (version, byte_order) = version(path, &bytes)?;
        if version == 2 {
            bytes.resize(BYTES_2, 0);
            read(path, &mut stream, &mut bytes[BYTES_1..])?;
        }
        let fields = Fields { bytes, byte_order };
        let is_single = is_single(path, &fields.bytes, version)?;
        if !is_single {
            // Nothing else reads a packed header to its end, where its checksum is.
            std::io::copy(&mut stream, &mut std::io::sink()).map_err(VolumeError::read(path))?;
        }
        Ok(match version {
            1 => fields.version_1(path, is_single),
            _ => fields.version_2(path, is_single),
        })
    }

    /// Where voxels start at the earliest in their file.
    pub fn earliest_voxels(&self) -> u64 {
        if self.is_single { self.bytes as u64 + EXTENSION_FLAG_BYTES } else { 0 }
    }
}

fn read(path: &Path, stream: &mut dyn Read, bytes: &mut [u8]) -> Result<(), VolumeError> {
    stream.read_exact(bytes).map_err(|cause| match cause.kind() {
        ErrorKind::UnexpectedEof => {
            let what = "a NIfTI header has 348 bytes (540 in version 2), and the file ends before";
            VolumeError::header(path, what)
        }
        _ => VolumeError::Read { path: path.into(), cause },
    })
}

fn version(path: &Path, bytes: &[u8]) -> Result<(u32, ByteOrder), VolumeError> {
    let size = [bytes[0], bytes[1], bytes[2], bytes[3]];
    match (i32::from_le_bytes(size), i32::from_be_bytes(size)) {
        (348, _) => Ok((1, ByteOrder::Little)),
        (_, 348) => Ok((1, ByteOrder::Big)),
        (540, _) => Ok((2, ByteOrder::Little)),
        (_, 540) => Ok((2, ByteOrder::Big)),
        (found, _) => {
            let what = format!("a NIfTI file starts with 348 or 540, and this one with {found}");
            Err(VolumeError::header(path, what))
        }
    }
}

fn is_single(path: &Path, bytes: &[u8], version: u32) -> Result<bool, VolumeError> {
    let at = if version == 1 { MAGIC_1 } else { MAGIC_2 };
    match (&bytes[at..at + 4], version) {
        (b"n+1\0", 1) | (b"n+2\0", 2) => Ok(true),
        (b"ni1\0", 1) | (b"ni2\0", 2) => Ok(false),
        (_, 1) => {
            let what = "it is an Analyze 7.5 file or damaged (no NIfTI magic): save it as NIfTI (.nii), which \
                        says where left and right are";
            Err(VolumeError::unsupported(path, what))
        }
        _ => Err(VolumeError::header(path, "its magic is neither n+2 nor ni2; copy the file again")),
    }
}

/// The bytes of a header, read at offsets.
struct Fields {
    bytes: Vec<u8>,
    byte_order: ByteOrder,
}

impl Fields {
    /// Offsets of nifti1.h of the NIfTI-1.1 standard.
    fn version_1(&self, path: &Path, is_single: bool) -> Header {
        Header {
            path: path.into(),
            byte_order: self.byte_order,
            is_single,
            dim: std::array::from_fn(|i| self.i16(40 + 2 * i).into()),
            datatype: self.i16(70),
            pixdim: self.f32s(76),
            vox_offset: self.f32(108),
            slope: self.f32(112),
            intercept: self.f32(116),
            units: i32::from(self.bytes[123]),
            qform_code: self.i16(252).into(),
            sform_code: self.i16(254).into(),
            quaternion: self.f32s(256),
            q_offset: self.f32s(268),
            s_rows: [self.f32s(280), self.f32s(296), self.f32s(312)],
            bytes: BYTES_1,
        }
    }

    /// Offsets of nifti2.h of the NIfTI-2 standard.
    fn version_2(&self, path: &Path, is_single: bool) -> Header {
        Header {
            path: path.into(),
            byte_order: self.byte_order,
            is_single,
            dim: std::array::from_fn(|i| self.i64(16 + 8 * i)),
            datatype: self.i16(12),
            pixdim: self.f64s(104),
            vox_offset: self.i64(168) as f64,
            slope: self.f64(176),
            intercept: self.f64(184),
            units: self.i32(500),
            qform_code: self.i32(344),
            sform_code: self.i32(348),
            quaternion: self.f64s(352),
            q_offset: self.f64s(376),
            s_rows: [self.f64s(400), self.f64s(432), self.f64s(464)],
            bytes: BYTES_2,
        }
    }

    /// The bytes of a number, least significant first.
    fn number<const N: usize>(&self, offset: usize) -> [u8; N] {
        let mut number = std::array::from_fn(|i| self.bytes[offset + i]);
        if self.byte_order == ByteOrder::Big {
            number.reverse();
        }
        number
    }

    fn i16(&self, offset: usize) -> i16 {
        i16::from_le_bytes(self.number(offset))
    }

    fn i32(&self, offset: usize) -> i32 {
        i32::from_le_bytes(self.number(offset))
    }

    fn i64(&self, offset: usize) -> i64 {
        i64::from_le_bytes(self.number(offset))
    }

    fn f32(&self, offset: usize) -> f64 {
        f32::from_le_bytes(self.number(offset)).into()
    }

    fn f64(&self, offset: usize) -> f64 {
        f64::from_le_bytes(self.number(offset))
    }

    fn f32s<const N: usize>(&self, offset: usize) -> [f64; N] {
        std::array::from_fn(|i| self.f32(offset + 4 * i))
    }

    fn f64s<const N: usize>(&self, offset: usize) -> [f64; N] {
        std::array::from_fn(|i| self.f64(offset + 8 * i))
    }
}
