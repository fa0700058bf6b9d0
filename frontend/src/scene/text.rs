//! The text of a scene file, and where in it something is.

use super::SceneError;
use display_config::Place;
use display_config::text::{brief_text, with_suggestion};
use std::ops::Range;

/// A scene file's text, with the name that messages call it by.
pub(super) struct SceneText {
    pub file: String,
    pub text: String,
}

impl SceneText {
    /// An error about what lies at a byte range of the text.
    pub fn wrong(&self, span: Range<usize>, message: impl Into<String>) -> SceneError {
        SceneError::InFile { place: self.place(span), message: message.into() }
    }

    /// Where a byte range of the text begins.
    pub fn place(&self, span: Range<usize>) -> Place {
        let start = span.start.min(self.text.len());
        Place {
            file: self.file.clone(),
            line: self.text[..start].matches('\n').count() + 1,
            key: brief_text(&self.key_at(start)).into_owned(),
        }
    }

    /// An error of the TOML reader.
    pub fn not_readable(&self, error: &toml::de::Error) -> SceneError {
        self.wrong(error.span().unwrap_or(0..0), with_suggestion(error.message()))
    }

    /// The key whose value holds a place: the last `key =` at or before its line, after the last table header.
    fn key_at(&self, start: usize) -> String {
        let end = self.text[start..].find('\n').map_or(self.text.len(), |n| start + n);
        let mut key = None;
        for line in self.text[..end].lines().rev() {
            let line = line.trim();
            if let Some(table) = table_name(line) {
                return key.map_or(table.to_owned(), |key| format!("{table}.{key}"));
            }
            if key.is_none() {
                key = key_name(line);
            }
        }
        key.unwrap_or("the scene").to_owned()
    }
}

/// The name in a `[table]` or `[[table]]` line; a line of an array of numbers is not one.
fn table_name(line: &str) -> Option<&str> {
    let name = line.split('#').next()?.trim().strip_prefix('[')?.strip_suffix(']')?;
    let name = name.strip_prefix('[').and_then(|n| n.strip_suffix(']')).unwrap_or(name).trim();
    is_bare(name).then_some(name)
}

fn key_name(line: &str) -> Option<&str> {
    let key = line.split_once('=')?.0.trim();
    is_bare(key).then_some(key)
}

/// Whether it begins as keys do: numbers in an array do not.
fn is_bare(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(text: &str, of: &str) -> String {
        let scene = SceneText { file: "a.toml".into(), text: text.into() };
        let start = text.find(of).unwrap();
        scene.wrong(start..start + 1, "no").to_string()
    }

    #[test]
    fn places_are_named_by_line_and_full_key() {
        let text = "name = 'a'\n[optics] # look\nextinction = [\n  [1.0, 2.0],\n  [3.0, 4.0],\n]\n[[keyframe]]\ntime_s = 9\n";
        assert_eq!(place(text, "'a'"), "a.toml, line 1: `name`: no");
        assert_eq!(place(text, "3.0"), "a.toml, line 5: `optics.extinction`: no");
        assert_eq!(place(text, "9"), "a.toml, line 8: `keyframe.time_s`: no");
        assert_eq!(place(text, "[optics"), "a.toml, line 2: `optics`: no");
    }
}
