//! From the text of an input file to inputs whose every value has been checked.

mod entry;
mod kinds;

use crate::error::InputError;
use crate::input::Input;
use display_config::text::{brief_text, read_text};
use entry::{Entry, Table};
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;

/// Inputs have numbers of 16 bits; far fewer are ever wanted.
const MOST_INPUTS: usize = 256;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
struct RawFile {
    input: Vec<Spanned<Table>>,
}

impl Input {
    /// The inputs of a file.
    ///
    /// # Errors
    /// A file that cannot be read, and those of [`Input::from_toml`].
    pub fn load(path: &Path) -> Result<Vec<Self>, InputError> {
        let text = read_text(path).map_err(|cause| InputError::Read { path: path.to_owned(), cause })?;
        Self::from_toml(path.parent().unwrap_or(Path::new("")), &text, &path.display().to_string())
    }

    /// The inputs that a file's text describes. `file` is what messages call it; scripts that it names are looked for in
    /// `folder`.
    ///
    /// # Errors
    /// Text that is not TOML, unknown or missing keys, values without meaning: each names the file, the line, the entry and
    /// the key.
    pub fn from_toml(folder: &Path, text: &str, file: &str) -> Result<Vec<Self>, InputError> {
        if let Err(error) = text.parse::<toml::Table>() {
            let line = entry::line(text, error.span().map_or(0, |span| span.start));
            let message = brief_text(&error.message().replace('\n', ", ")).into_owned();
            return Err(InputError::Syntax { file: file.to_owned(), line, message });
        }
        let no_inputs = |message: &str| InputError::NoInputs {
            file: file.to_owned(),
            message: brief_text(message).into(),
        };
        let raw: RawFile = toml::from_str(text).map_err(|error| no_inputs(error.message()))?;
        if raw.input.is_empty() || raw.input.len() > MOST_INPUTS {
            return Err(no_inputs(&format!(
                "it has {} entries, and from 1 to {MOST_INPUTS} are read",
                raw.input.len()
            )));
        }
        let mut inputs: Vec<Self> = Vec::with_capacity(raw.input.len());
        for (number, table) in (1..).zip(&raw.input) {
            let entry = Entry::new(text, file, number, table);
            let input = kinds::input(&entry, folder)?;
            if inputs.iter().any(|other| other.name == input.name) {
                return Err(InputError::DuplicateName { place: entry.place("name") });
            }
            inputs.push(input);
        }
        Ok(inputs)
    }
}

#[cfg(test)]
#[path = "../file_tests.rs"]
mod tests;
