//! A text header: lines at the start of a file, before binary voxels.

use bricks::volume::{VolumeError, open_file};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Longest header that is read.
const LONGEST_HEADER_BYTES: u64 = 1 << 20;

/// The key-value pairs of a header, keys in lower case.
pub(super) struct HeaderText {
    path: PathBuf,
    fields: Vec<(String, String)>,
    /// What stands on the lines after [`Line::List`], one name a line.
    pub listed: Vec<String>,
    /// Bytes of the header, its end mark included.
    pub length: u64,
}

/// What a line of a header is.
pub(super) enum Line {
    Field(String, String),
    /// A field after which the header ends.
    Last(String, String),
    /// A field after which the rest of the file is a list of names.
    List(String, String),
    Ignored,
    /// The header's end, not a field itself.
    End,
    Wrong,
}

impl HeaderText {
    /// Reads lines until the format's `line` function says that the header ends, or the file does.
    pub fn read(path: &Path, line: impl Fn(usize, &str) -> Line) -> Result<Self, VolumeError> {
        let file = open_file(path).map_err(VolumeError::open(path))?;
        let mut bytes = Vec::new();
        file.take(LONGEST_HEADER_BYTES).read_to_end(&mut bytes).map_err(VolumeError::read(path))?;
        let mut header = Self { path: path.into(), fields: Vec::new(), listed: Vec::new(), length: 0 };
        let mut is_list = false;
        for (number, raw) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
            header.length += raw.len() as u64;
            let text = String::from_utf8_lossy(raw);
            if is_list {
                header.listed.extend(Some(text.trim().to_owned()).filter(|name| !name.is_empty()));
                continue;
            }
            let line = line(number, text.trim_end_matches(['\r', '\n']));
            is_list = matches!(line, Line::List(..));
            if header.take(number, line, &text)? {
                return Ok(header);
            }
        }
        if header.length == LONGEST_HEADER_BYTES {
            return Err(header.wrong("it does not end within 1 MiB; is this another kind of file?"));
        }
        Ok(header)
    }

    /// Keeps what a line says; true if the header ends with it.
    fn take(&mut self, number: usize, line: Line, text: &str) -> Result<bool, VolumeError> {
        match line {
            Line::Field(key, value) | Line::List(key, value) => {
                self.fields.push((key.to_ascii_lowercase(), value))
            }
            Line::Last(key, value) => {
                self.fields.push((key.to_ascii_lowercase(), value));
                return Ok(true);
            }
            Line::Ignored => {}
            Line::End => return Ok(true),
            Line::Wrong => {
                let shown: String = text.trim_end().chars().take(40).collect();
                let number = number + 1;
                return Err(self.wrong(format!("line {number} is not understood: {shown:?}")));
            }
        }
        Ok(false)
    }

    /// An error about this header.
    pub fn wrong(&self, what: impl Into<String>) -> VolumeError {
        VolumeError::header(&self.path, what)
    }

    /// The value of a key that may be there, under any of its names.
    pub fn get(&self, names: &[&str]) -> Option<&str> {
        let found = self.fields.iter().find(|(key, _)| names.contains(&key.as_str()));
        found.map(|(_, value)| value.trim())
    }

    /// The value of a key that must be there.
    pub fn need(&self, name: &str) -> Result<&str, VolumeError> {
        self.get(&[name]).ok_or_else(|| self.wrong(format!("it has no line for `{name}`")))
    }

    /// A value as one number.
    pub fn number<T: std::str::FromStr>(&self, key: &str, value: &str) -> Result<T, VolumeError> {
        value
            .parse()
            .map_err(|_| self.wrong(format!("`{key}` is {value:?}, which is not the number expected")))
    }

    /// A value as numbers between blanks.
    pub fn numbers<T: std::str::FromStr>(&self, key: &str, value: &str) -> Result<Vec<T>, VolumeError> {
        value.split_whitespace().map(|part| self.number(key, part)).collect()
    }

    /// A value as `count` numbers between blanks.
    pub fn exactly<T: std::str::FromStr>(
        &self,
        key: &str,
        value: &str,
        count: usize,
    ) -> Result<Vec<T>, VolumeError> {
        let numbers = self.numbers(key, value)?;
        match numbers.len() == count {
            true => Ok(numbers),
            false => Err(self.wrong(format!("`{key}` is {value:?}, and {count} numbers are expected"))),
        }
    }

    /// The folder of the header, which names of other files start from.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// A file named in the header, relative to the header's folder.
    pub fn beside(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }
}
