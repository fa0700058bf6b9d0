//! Which images lie in a folder, and which series they make.

use super::header::{self, Frame};
use super::start::Start;
use bricks::volume::VolumeError;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Folders within folders that are looked into: a study, its series, their files.
const DEEPEST: usize = 3;
/// Cosines and spacings that differ less are the same: they are decimal numbers of a few digits.
const SAME: f64 = 1e-3;

/// Images that can lie in one volume.
pub(super) type Series = Vec<Frame>;

/// Whether a folder holds a DICOM file.
pub(crate) fn is_in(folder: &Path) -> Result<bool, VolumeError> {
    let mut paths = Vec::new();
    list(folder, DEEPEST, &mut paths)?;
    for path in paths {
        if Start::of_file(&path)?.is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// All series in a folder, by number and UID; none where it holds no DICOM image.
pub(super) fn series_in(folder: &Path) -> Result<Vec<Series>, VolumeError> {
    let mut paths = Vec::new();
    list(folder, DEEPEST, &mut paths)?;
    // The order of a listing is chance; errors and the choice between equals must not be.
    paths.sort();
    let files: Result<Vec<Vec<Frame>>, VolumeError> =
        paths.par_iter().map(|path| header::read(path)).collect();
    Ok(group(files?.into_iter().flatten()))
}

/// The series in one file, or the one in its folder that it belongs to where it holds a single image.
pub(super) fn series_of(path: &Path) -> Result<Vec<Series>, VolumeError> {
    let frames = header::read(path)?;
    let Some(first) = frames.first().cloned() else {
        return Err(VolumeError::unsupported(path, "it holds no image: give the folder with the images"));
    };
    if frames.len() > 1 {
        return Ok(group(frames.into_iter()));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut paths = Vec::new();
    list(folder, 1, &mut paths)?;
    paths.sort();
    // Other files of the folder were not asked for: those that cannot be read belong to no series of it.
    let others = paths.par_iter().filter_map(|path| header::read(path).ok());
    let others: Vec<Frame> = others.collect::<Vec<_>>().into_iter().flatten().collect();
    let own = group(others.into_iter()).into_iter().find(|series| belongs(&first, series));
    Ok(vec![own.unwrap_or_else(|| vec![first])])
}

fn list(folder: &Path, depth: usize, paths: &mut Vec<PathBuf>) -> Result<(), VolumeError> {
    for entry in std::fs::read_dir(folder).map_err(VolumeError::open(folder))? {
        let path = entry.map_err(VolumeError::open(folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with('.') || name.eq_ignore_ascii_case("DICOMDIR") {
            continue;
        }
        // Not the entry's own type: it may be a link.
        let is_folder = path.is_dir();
        if is_folder && depth > 1 {
            list(&path, depth - 1, paths)?;
        } else if path.is_file() {
            paths.push(path);
        }
    }
    Ok(())
}

/// Series by their UID, size, orientation and spacing: a localizer that lies across is a series of its own.
fn group(frames: impl Iterator<Item = Frame>) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    for frame in frames {
        match all.iter_mut().find(|series| belongs(&frame, series)) {
            Some(series) => series.push(frame),
            None => all.push(vec![frame]),
        }
    }
    all.sort_by(|a, b| key(a).cmp(&key(b)));
    all
}

fn key(series: &Series) -> (i64, &str) {
    (series[0].file.series_number, &series[0].file.series_uid)
}

fn belongs(frame: &Frame, series: &Series) -> bool {
    let (a, b) = (frame, &series[0]);
    let looks_alike = match (&a.pose, &b.pose) {
        (Some(a), Some(b)) => {
            a.along_row.abs_diff_eq(b.along_row, SAME) && a.along_column.abs_diff_eq(b.along_column, SAME)
        }
        (a, b) => a.is_none() && b.is_none(),
    };
    let is_as_fine = match (a.spacing_mm, b.spacing_mm) {
        (Some(a), Some(b)) => a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * b.abs()),
        (a, b) => a.is_none() && b.is_none(),
    };
    let (a, b) = (&a.file, &b.file);
    looks_alike
        && is_as_fine
        && (&a.series_uid, a.rows, a.columns) == (&b.series_uid, b.rows, b.columns)
        && a.samples_per_pixel == b.samples_per_pixel
}

/// The series that the user asked for, or the only one.
pub(super) fn choose(path: &Path, mut all: Vec<Series>, asked: Option<&str>) -> Result<Series, VolumeError> {
    let Some(asked) = asked.map(str::trim) else {
        return match all.len() {
            1 => Ok(all.remove(0)),
            _ => Err(ambiguous(path, "it holds", &all)),
        };
    };
    if let Some(number) = asked.parse().ok().filter(|number| (1..=all.len()).contains(number)) {
        return Ok(all.remove(number - 1));
    }
    let is_asked = |series: &Series| {
        let uid = &series[0].file.series_uid;
        !asked.is_empty() && (uid.starts_with(asked) || uid.ends_with(asked))
    };
    match all.iter().filter(|series| is_asked(series)).count() {
        1 => Ok(all.into_iter().find(is_asked).expect("one was counted")),
        0 => Err(ambiguous(path, &format!("series {asked} is not among its"), &all)),
        _ => Err(ambiguous(path, &format!("series {asked} may be several of its"), &all)),
    }
}

fn ambiguous(path: &Path, what: &str, all: &[Series]) -> VolumeError {
    let list: Vec<String> = all.iter().enumerate().map(|(i, series)| describe(i + 1, series)).collect();
    let what = format!(
        "{what} {} series: {}; choose one by its number, or by the start or end of its UID",
        all.len(),
        list.join(", ")
    );
    VolumeError::unsupported(path, what)
}

/// Enough of the end of a UID to distinguish series.
const SHOWN_UID_CHARS: usize = 12;

fn describe(number: usize, series: &Series) -> String {
    let file = &series[0].file;
    let skipped = file.series_uid.chars().count().saturating_sub(SHOWN_UID_CHARS);
    let uid: String = file.series_uid.chars().skip(skipped).collect();
    format!(
        "{number} \"{}\" ({}, {} slices of {} × {}, UID …{uid})",
        file.description,
        file.modality,
        series.len(),
        file.columns,
        file.rows
    )
}
