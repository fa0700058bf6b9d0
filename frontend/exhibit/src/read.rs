//! From the text of an exhibit file to an exhibit, with all that is wrong with it.

use crate::exhibit::Exhibit;
use crate::fault::Fault;
use crate::raw::{KEYS, RawFile};
use display_config::text::{brief_text, did_you_mean, read_text, with_suggestion};
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};
use toml::{Spanned, Value};
use world::{Cast, Rules};

/// Frames per second that a display may have.
const RATES_HZ: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

/// What reads a file, and what it has found wrong.
pub(crate) struct Reader<'a> {
    text: &'a str,
    file: &'a str,
    pub(crate) folder: &'a Path,
    pub(crate) faults: Vec<Fault>,
}

impl Reader<'_> {
    /// The line of a place in the text, from 1.
    pub(crate) fn line(&self, at: usize) -> usize {
        1 + self.text.get(..at).unwrap_or_default().matches('\n').count()
    }

    /// Something is wrong with what begins on a line.
    pub(crate) fn wrong(&mut self, line: usize, what: impl Into<String>) {
        self.faults.push(Fault { file: self.file.to_owned(), line: Some(line), what: what.into() });
    }

    pub(crate) fn wrong_file(&mut self, what: impl Into<String>) {
        self.faults.push(Fault { file: self.file.to_owned(), line: None, what: what.into() });
    }

    /// An entry of a kind, with the line at which it begins; None, and a fault, where it is none.
    pub(crate) fn entry<T: DeserializeOwned>(
        &mut self,
        kind: &str,
        value: &Spanned<Value>,
    ) -> Option<(usize, T)> {
        let line = self.line(value.span().start);
        match value.get_ref().clone().try_into() {
            Ok(entry) => Some((line, entry)),
            Err(error) => {
                let message = brief_text(&with_suggestion(error.message())).into_owned();
                self.wrong(line, format!("[{kind}] cannot be read ({message}); correct the entry"));
                None
            }
        }
    }

    /// A number that must be within bounds; a fault, and None, where it is not.
    pub(crate) fn within(
        &mut self,
        line: usize,
        key: &str,
        number: Option<f64>,
        bounds: std::ops::RangeInclusive<f64>,
    ) -> Option<f64> {
        let number = number?;
        if bounds.contains(&number) {
            return Some(number);
        }
        let (least, most) = bounds.into_inner();
        self.wrong(line, format!("`{key}` is {number}; give a number from {least} to {most}"));
        None
    }
}

impl Exhibit {
    /// The exhibit of a file.
    ///
    /// # Errors
    /// All that is wrong with it, in the order of the lines. Where the file is no TOML, that alone.
    pub fn load(path: &Path) -> Result<Self, Vec<Fault>> {
        let file = path.display().to_string();
        let text = read_text(path).map_err(|cause| {
            let what = format!("it cannot be read ({cause}); give the path of a readable .toml file");
            vec![Fault { file: file.clone(), line: None, what }]
        })?;
        Self::from_toml(path.parent().unwrap_or(Path::new("")), &text, &file)
    }

    /// The exhibit that a text describes. `file` is what messages call it; what it names is looked for in `folder`.
    ///
    /// # Errors
    /// See [`Exhibit::load`].
    pub fn from_toml(folder: &Path, text: &str, file: &str) -> Result<Self, Vec<Fault>> {
        let reader = Reader { text, file, folder, faults: Vec::new() };
        reader.read(|reader, raw| reader.exhibit(raw))
    }

    /// Who takes part in the exhibit that a text describes, and what they may do. Its sources of inputs have these names, so
    /// that the text is enough, as on a tape.
    ///
    /// # Errors
    /// See [`Exhibit::load`].
    pub fn cast_from_toml(text: &str, file: &str, inputs: &[&str]) -> Result<(Cast, Rules), Vec<Fault>> {
        let reader = Reader { text, file, folder: Path::new(""), faults: Vec::new() };
        reader.read(|reader, raw| {
            let cast = reader.cast(&raw.visitor, &raw.tool, inputs);
            (cast, reader.rules(raw.idle.as_ref(), raw.limits.as_ref()))
        })
    }

    /// Whether a text is an exhibit's, and not a scene's: it has items.
    pub fn is_one(text: &str) -> bool {
        text.parse::<toml::Table>().is_ok_and(|table| table.contains_key("item"))
    }
}

impl Reader<'_> {
    /// What is made of the text, if nothing is wrong with that.
    fn read<T>(mut self, make: impl FnOnce(&mut Self, RawFile) -> T) -> Result<T, Vec<Fault>> {
        let made = self.raw().map(|raw| make(&mut self, raw));
        self.faults.sort();
        made.filter(|_| self.faults.is_empty()).ok_or(self.faults)
    }

    /// The entries of the text; None, and a fault, where it is no TOML or no exhibit's.
    fn raw(&mut self) -> Option<RawFile> {
        let table = match self.text.parse::<toml::Table>() {
            Ok(table) => table,
            Err(error) => {
                let line = self.line(error.span().map_or(0, |span| span.start));
                let message = brief_text(&error.message().replace('\n', ", ")).into_owned();
                self.wrong(line, format!("this is not TOML ({message}); correct the line first"));
                return None;
            }
        };
        for key in table.keys().filter(|key| !KEYS.contains(&key.as_str())) {
            let (key, suggestion) = (brief_text(key).into_owned(), did_you_mean(key, KEYS));
            let known = KEYS.join(", ");
            self.wrong_file(format!(
                "`{key}` is no key of an exhibit{suggestion}; remove it, or use one of {known}"
            ));
        }
        match toml::from_str(self.text) {
            Ok(raw) => Some(raw),
            Err(error) => {
                let line = self.line(error.span().map_or(0, |span| span.start));
                let message = brief_text(&with_suggestion(error.message())).into_owned();
                self.wrong(line, format!("this cannot be read ({message}); correct it first"));
                None
            }
        }
    }

    fn exhibit(&mut self, raw: RawFile) -> Exhibit {
        if raw.display.is_none() {
            self.wrong_file("it names no display; add `display = \"desk8\"`, or another preset or file");
        }
        let rate_hz = raw.rate_hz;
        if rate_hz.is_some_and(|rate| !RATES_HZ.contains(&rate)) {
            self.wrong_file("`rate_hz` must be from 1 to 1000 frames a second");
        }
        let (inputs, inputs_file) = self.inputs(raw.inputs.as_ref());
        let items = self.items(&raw.item);
        let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
        let cast = self.cast(&raw.visitor, &raw.tool, &names);
        let rules = self.rules(raw.idle.as_ref(), raw.limits.as_ref());
        let tape = self.tape(raw.tape.as_ref());
        let marks = self.marks(raw.marks.as_ref());
        Exhibit {
            title: raw.title.unwrap_or_else(|| "exhibit".to_owned()),
            file: self.file.to_owned(),
            display: raw.display.map(|display| self.path_or_preset(&display)).unwrap_or_default(),
            rate_hz,
            quality: raw.quality,
            items,
            cast,
            rules,
            inputs,
            tape,
            marks,
            files: std::iter::once(PathBuf::from(self.file)).chain(inputs_file).collect(),
        }
    }

    /// A file in the folder of the exhibit if it is there, and else a name as it stands.
    pub(crate) fn path_or_preset(&self, name: &str) -> String {
        let path = self.folder.join(name);
        if path.exists() { path.display().to_string() } else { name.to_owned() }
    }

    fn inputs(&mut self, file: Option<&Spanned<PathBuf>>) -> (Vec<inputs::Input>, Option<PathBuf>) {
        let Some(file) = file else { return (Vec::new(), None) };
        let (line, path) = (self.line(file.span().start), self.folder.join(file.get_ref()));
        let inputs = inputs::Input::load(&path).unwrap_or_else(|error| {
            self.wrong(line, format!("`inputs` names a file that cannot be used: {error}"));
            Vec::new()
        });
        (inputs, Some(path))
    }
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
