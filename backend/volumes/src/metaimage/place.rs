//! Where the voxels of a MetaImage header are.

use super::super::data_files::{DataFiles, Numbered};
use super::super::data_stream::Start;
use super::super::header_text::HeaderText;
use super::super::packing::Packing;
use bricks::volume::VolumeError;
use std::path::Path;

/// The name of the field that says where the voxels are, and ends the header.
pub(super) const DATA_FILE: &str = "ElementDataFile";
/// The value of that field, before the names of several files on the lines that follow.
const LIST: &str = "LIST";
const LOCAL: [&str; 2] = ["LOCAL", "local"];

/// Whether the value of the field says that names follow.
pub(super) fn is_list(value: &str) -> bool {
    value.split_whitespace().next() == Some(LIST)
}

/// The files with the voxels: the header's own, one beside it, or several of them, listed or numbered.
pub(super) fn files(path: &Path, header: &HeaderText, sizes: &[i64]) -> Result<DataFiles, VolumeError> {
    let name = data_file(header)?;
    let (files, file_axes) = if is_list(name) {
        let files = DataFiles::Listed { folder: header.folder().into(), names: header.listed.clone() };
        (files, file_axes(header, name, sizes.len())?)
    } else if let Some(numbered) = numbered(header, name, sizes) {
        (DataFiles::Numbered(numbered), sizes.len() - 1)
    } else if LOCAL.contains(&name) {
        return Ok(DataFiles::One(path.into()));
    } else {
        return Ok(DataFiles::One(header.beside(name)));
    };
    files.check_count(sizes, file_axes).map_err(|what| header.wrong(what))?;
    Ok(files)
}

fn data_file(header: &HeaderText) -> Result<&str, VolumeError> {
    match header.need("elementdatafile")? {
        "" => Err(header.wrong("`ElementDataFile` is empty, and must be LOCAL or the name of a file")),
        name => Ok(name),
    }
}

/// `LIST`, `LIST 2` or `LIST 2D`: how many axes each file has.
fn file_axes(header: &HeaderText, value: &str, axes: usize) -> Result<usize, VolumeError> {
    match value.split_whitespace().nth(1) {
        None => Ok(axes - 1),
        Some(count) => header.number(DATA_FILE, count.trim_end_matches(['D', 'd'])),
    }
}

/// `name%03d.raw first last step`, whose numbers are 1, as many as the last axis has, and 1 if they are not given.
fn numbered(header: &HeaderText, value: &str, sizes: &[i64]) -> Option<Numbered> {
    let mut range = [1, *sizes.last()?, 1];
    let mut words = value.split_whitespace();
    let template = words.next()?;
    for (slot, word) in range.iter_mut().zip(words) {
        *slot = word.parse().ok()?;
    }
    Numbered::new(header.folder(), template, range)
}

/// What precedes the voxels: the header, or as many bytes of another file as the header says.
pub(super) fn start(header: &HeaderText, packing: Packing) -> Result<Start, VolumeError> {
    if LOCAL.contains(&data_file(header)?) {
        return Ok(Start { header_bytes: header.length, ..Start::default() });
    }
    match header.get(&["headersize"]) {
        None => Ok(Start::default()),
        Some("-1") if packing == Packing::Plain => Ok(Start { is_from_end: true, ..Start::default() }),
        Some("-1") => {
            Err(header.wrong("`HeaderSize` is -1, which needs voxels that are plain binary numbers"))
        }
        Some(value) => Ok(Start { header_bytes: header.number("HeaderSize", value)?, ..Start::default() }),
    }
}
