//! Why a volume could not be read.

use std::path::{Path, PathBuf};

/// Why a volume could not be read: one sentence that names the file and says what to do.
#[derive(Debug, thiserror::Error)]
pub enum VolumeError {
    /// The file is missing, or may not be read.
    #[error("cannot open {}: {cause}; check the path and the permissions", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The file opened, and then reading failed.
    #[error("cannot read {}: {cause}; the file may be damaged: copy it again", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system or the decompressor said.
        cause: std::io::Error,
    },
    /// Fewer bytes than the header promises.
    #[error("{} is too short: {promised} bytes of voxels are promised and {found}; copy the file again or correct its header", path.display())]
    Truncated {
        /// The file with the voxels.
        path: PathBuf,
        /// Bytes that dimensions and element type make.
        promised: u64,
        /// What there is.
        found: String,
    },
    /// A header that cannot be understood.
    #[error("the header of {} is wrong: {what}", path.display())]
    Header {
        /// The file with the header.
        path: PathBuf,
        /// What is wrong, and what would be right.
        what: String,
    },
    /// A valid file of a kind that is not read here.
    #[error("{} cannot be read: {what}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What lacks support, and what to convert to.
        what: String,
    },
    /// Neither extension nor first bytes are known.
    #[error(
        "the format of {} is not known: give a DICOM, TIFF, NRRD, NIfTI or MetaImage file, or a folder of a DICOM series, of TIFF slices or of OME-Zarr, or say dimensions, element type, byte order and spacing of a raw file",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The raw layout does not make the file's length.
    #[error(
        "{} has {found} bytes after the {skip} that are skipped, but {what} are {promised}: correct dimensions, element type or header size",
        path.display()
    )]
    RawSize {
        /// The file.
        path: PathBuf,
        /// Bytes after the header.
        found: u64,
        /// Bytes of the header.
        skip: u64,
        /// Dimensions and type in words.
        what: String,
        /// Bytes that these make.
        promised: u64,
    },
    /// Only NaN and infinity.
    #[error("{name} has no finite value: there is nothing to show; check how it was written")]
    NoFiniteValue {
        /// The volume.
        name: String,
    },
    /// No value is one of f32.
    #[error(
        "{name} has no value within {:.2e}, the largest that single precision holds: scale its values down",
        f32::MAX
    )]
    BeyondSinglePrecision {
        /// The volume.
        name: String,
    },
    /// A procedural volume that does not exist or cannot have that size.
    #[error("there is no procedural volume {name}: {what}")]
    Procedural {
        /// The name asked for.
        name: String,
        /// What would be right.
        what: String,
    },
}

impl VolumeError {
    /// The header of the file says what no header may say.
    pub fn header(path: &Path, what: impl Into<String>) -> Self {
        VolumeError::Header { path: path.into(), what: what.into() }
    }

    /// The file holds what this reader does not read.
    pub fn unsupported(path: &Path, what: impl Into<String>) -> Self {
        VolumeError::Unsupported { path: path.into(), what: what.into() }
    }

    /// The file cannot be opened.
    pub fn open(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |cause| VolumeError::Open { path: path.into(), cause }
    }

    /// The file cannot be read.
    pub fn read(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |cause| VolumeError::Read { path: path.into(), cause }
    }
}
