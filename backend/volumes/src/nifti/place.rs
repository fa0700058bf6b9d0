//! The files of a NIfTI volume.

use super::super::data_files::DataFiles;
use super::super::packing::Packing;
use super::header::Header;
use super::unpacked::is_gzip;
use bricks::volume::VolumeError;
use std::path::{Path, PathBuf};

/// The header's file of a pair, whichever of the two was named; any other path as it is.
pub(super) fn header_path(path: &Path) -> Result<PathBuf, VolumeError> {
    if !ends(path, ".img") && !ends(path, ".img.gz") {
        return Ok(path.into());
    }
    // Of a pair, either file may be packed and the other not.
    let beside = [".hdr", ".hdr.gz", ".HDR"].map(|ending| with_ending(path, ending));
    beside.iter().find(|path| path.exists()).cloned().ok_or_else(|| {
        let header = beside[0].display();
        let what = format!("its header {header} is not there: copy it too, or say what the raw voxels are");
        VolumeError::unsupported(path, what)
    })
}

/// The file of the voxels, and how it is packed.
pub(super) fn voxels(header: &Header) -> Result<(DataFiles, Packing), VolumeError> {
    if header.is_single {
        let packing = if is_gzip(&header.path)? { Packing::Gzip } else { Packing::Plain };
        return Ok((DataFiles::One(header.path.clone()), packing));
    }
    let beside = [".img", ".img.gz", ".IMG"].map(|ending| with_ending(&header.path, ending));
    let path = beside.iter().find(|path| path.exists()).unwrap_or(&beside[0]).clone();
    // The first voxels may look like the start of a packed file, so the name decides.
    let packing = if ends(&path, ".gz") { Packing::Gzip } else { Packing::Plain };
    Ok((DataFiles::One(path), packing))
}

fn ends(path: &Path, ending: &str) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().to_ascii_lowercase().ends_with(ending))
}

/// The path with another ending instead of its own, of which `.gz` is a part.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let unpacked = if ends(path, ".gz") { path.with_extension("") } else { path.into() };
    unpacked.with_extension(&ending[1..])
}
