//! Where the voxels of an NRRD header are.

use super::super::data_files::{DataFiles, Numbered};
use super::super::data_stream::Start;
use super::super::file::Packing;
use super::super::header_text::HeaderText;
use super::{DATA_FILE, LIST};
use bricks::volume::VolumeError;
use std::path::Path;

/// The files with the voxels: the header's own, one beside it, or several of them, listed or numbered.
pub(super) fn files(path: &Path, header: &HeaderText, sizes: &[i64]) -> Result<DataFiles, VolumeError> {
    let Some(value) = header.get(&DATA_FILE) else { return Ok(DataFiles::One(path.into())) };
    if value.is_empty() {
        return Err(header.wrong("`data file` is empty, and must be the name of a file"));
    }
    let (files, file_axes) = if let Some(file_axes) = value.strip_prefix(LIST).filter(|_| is_list(value)) {
        (DataFiles::Listed { folder: header.folder().into(), names: header.listed.clone() }, file_axes.trim())
    } else if let Some((files, file_axes)) = numbered(header, value) {
        (files, file_axes)
    } else {
        return Ok(DataFiles::One(header.beside(value)));
    };
    let file_axes = match file_axes {
        "" => sizes.len() - 1,
        count => header.number("data file", count)?,
    };
    files.check_count(sizes, file_axes).map_err(|what| header.wrong(what))?;
    Ok(files)
}

fn is_list(value: &str) -> bool {
    value.split_whitespace().next() == Some(LIST)
}

/// `name%03d.raw first last step`, and how many axes a file has where that follows.
fn numbered<'a>(header: &HeaderText, value: &'a str) -> Option<(DataFiles, &'a str)> {
    let words: Vec<&str> = value.split_whitespace().collect();
    let numbers = words.iter().rev().take_while(|word| word.parse::<i64>().is_ok()).count().min(4);
    if numbers < 3 {
        return None;
    }
    let first = words.len() - numbers;
    let range: Vec<i64> = words[first..first + 3].iter().filter_map(|word| word.parse().ok()).collect();
    // The name may have blanks, so it ends where the numbers start.
    let template = words[first].as_ptr() as usize - value.as_ptr() as usize;
    let files = Numbered::new(header.folder(), value[..template].trim_end(), range.try_into().ok()?)?;
    Some((DataFiles::Numbered(files), words.get(first + 3).copied().unwrap_or("")))
}

/// What precedes the voxels: lines, then bytes (after unpacking).
pub(super) fn start(header: &HeaderText, packing: Packing) -> Result<Start, VolumeError> {
    let header_bytes = if header.get(&DATA_FILE).is_some() { 0 } else { header.length };
    let lines = match header.get(&["line skip", "lineskip"]) {
        Some(value) => header.number("line skip", value)?,
        None => 0,
    };
    let skip: i64 = match header.get(&["byte skip", "byteskip"]) {
        Some(value) => header.number("byte skip", value)?,
        None => 0,
    };
    let is_from_end = skip == -1 && packing == Packing::Plain;
    match u64::try_from(skip) {
        Ok(unpacked_bytes) => Ok(Start { header_bytes, lines, unpacked_bytes, is_from_end }),
        Err(_) if is_from_end => Ok(Start { is_from_end, ..Start::default() }),
        Err(_) => {
            Err(header.wrong(format!("`byte skip` is {skip}, and negative only as -1 with raw encoding")))
        }
    }
}
