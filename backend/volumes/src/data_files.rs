//! The names of the files that hold a volume's voxels, one after the other.

use bricks::volume::MAX_EDGE_VOXELS;
use std::path::{Path, PathBuf};

/// Digits to which a number in a name is filled up at most; no file system takes names of more bytes.
const WIDEST_NUMBER: usize = 255;

/// One file or several, each of which holds as many voxels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum DataFiles {
    One(PathBuf),
    /// Files of one folder.
    Listed {
        folder: PathBuf,
        names: Vec<String>,
    },
    Numbered(Numbered),
}

/// Files of one folder whose names differ by a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Numbered {
    folder: PathBuf,
    before: String,
    after: String,
    /// Characters of the number at least, filled up with `fill`.
    width: usize,
    fill: char,
    first: i64,
    step: i64,
    count: usize,
}

impl DataFiles {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            DataFiles::One(_) => 1,
            DataFiles::Listed { names, .. } => names.len(),
            DataFiles::Numbered(numbered) => numbered.count,
        }
    }

    /// The path of one of them.
    pub fn path(&self, index: usize) -> PathBuf {
        match self {
            DataFiles::One(path) => path.clone(),
            DataFiles::Listed { folder, names } => folder.join(&names[index]),
            DataFiles::Numbered(numbered) => numbered.path(index),
        }
    }

    /// Whether there are as many files as an array of these sizes needs, where each file holds its first `file_axes`
    /// axes; a file of all axes holds a part of the last one. What is wrong comes back as the end of a sentence.
    pub fn check_count(&self, sizes: &[i64], file_axes: usize) -> Result<(), String> {
        let files = self.len() as i64;
        if !(1..=sizes.len()).contains(&file_axes) {
            return Err(format!("a file of voxels cannot have {file_axes} of its {} axes", sizes.len()));
        }
        let expected = sizes[file_axes..].iter().fold(1i64, |n, &size| n.saturating_mul(size));
        let last = sizes.last().copied().unwrap_or(1);
        let is_part = file_axes == sizes.len() && files > 0 && last % files == 0;
        if is_part || files == expected {
            return Ok(());
        }
        Err(format!("it names {files} files of voxels, and its dimensions need {expected}"))
    }
}

impl Numbered {
    /// Files named as C's printf makes names of a template (`slice%03d.raw`) and the numbers from `first` to `last`;
    /// None if the template has no such number or the numbers do not make a range.
    pub fn new(folder: &Path, template: &str, [first, last, step]: [i64; 3]) -> Option<Self> {
        let count = last.checked_sub(first)?.checked_div(step)?.checked_add(1)?;
        let count = usize::try_from(count).ok().filter(|count| *count <= MAX_EDGE_VOXELS as usize)?;
        let (before, rest) = template.split_once('%')?;
        let conversion = rest.find(['d', 'i', 'u'])?;
        let digits = &rest[..conversion];
        let width = match digits.trim_start_matches('0') {
            "" => 0,
            digits if digits.bytes().all(|byte| byte.is_ascii_digit()) => digits.parse().ok()?,
            _ => return None,
        };
        Some(Self {
            folder: folder.into(),
            before: before.into(),
            after: rest[conversion + 1..].into(),
            width: if width > WIDEST_NUMBER { return None } else { width },
            fill: if digits.starts_with('0') { '0' } else { ' ' },
            first,
            step,
            count,
        })
    }

    fn path(&self, index: usize) -> PathBuf {
        let number = self.first + self.step * index as i64;
        let sign = if number < 0 { "-" } else { "" };
        let digits = number.unsigned_abs().to_string();
        let fill: String =
            std::iter::repeat_n(self.fill, self.width.saturating_sub(sign.len() + digits.len())).collect();
        // Zeros come after the sign, blanks before it.
        let number = match self.fill {
            '0' => format!("{sign}{fill}{digits}"),
            _ => format!("{fill}{sign}{digits}"),
        };
        self.folder.join(format!("{}{number}{}", self.before, self.after))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(template: &str, range: [i64; 3]) -> Option<Vec<PathBuf>> {
        let files = DataFiles::Numbered(Numbered::new(Path::new("f"), template, range)?);
        Some((0..files.len()).map(|index| files.path(index)).collect())
    }

    #[test]
    fn numbers_are_written_as_printf_does() {
        let of =
            |names: &[&str]| Some(names.iter().map(|name| Path::new("f").join(name)).collect::<Vec<_>>());
        assert_eq!(names("s%03d.raw", [8, 12, 2]), of(&["s008.raw", "s010.raw", "s012.raw"]));
        assert_eq!(names("%d", [1, -1, -1]), of(&["1", "0", "-1"]));
        assert_eq!(names("a%3ib", [-1, 0, 1]), of(&["a -1b", "a  0b"]));
        assert_eq!(names("a%03ub", [-1, -1, 1]), of(&["a-01b"]));
    }

    #[test]
    fn what_is_no_pattern_is_no_pattern() {
        for template in ["50%.raw", "slice.raw", "%s", "%999d", "%-3d", "%99999999999999999999d"] {
            assert_eq!(names(template, [1, 2, 1]), None, "{template}");
        }
        for range in [[1, 2, 0], [3, 1, 1], [0, 1 << 20, 1], [i64::MIN, i64::MAX, 1], [i64::MIN, 0, -1]] {
            assert_eq!(names("%d", range), None, "{range:?}");
        }
    }
}
