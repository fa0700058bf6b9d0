//! One entry of an input file, which knows the line of each of its keys.

use crate::error::{InputError, Place};
use display_config::text::{brief_text, did_you_mean};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;
use toml::{Spanned, Value};

/// Keys and values.
pub(super) type Table = BTreeMap<Spanned<String>, Spanned<Value>>;

pub(super) struct Entry<'a> {
    text: &'a str,
    file: &'a str,
    name: String,
    table: &'a Spanned<Table>,
}

/// The line of an offset, from 1.
pub(super) fn line(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|&byte| byte == b'\n').count()
}

impl<'a> Entry<'a> {
    pub fn new(text: &'a str, file: &'a str, number: usize, table: &'a Spanned<Table>) -> Self {
        let mut entry = Self { text, file, name: number.to_string(), table };
        if let Some(name) = entry.value("name").and_then(|value| value.get_ref().as_str()) {
            entry.name = format!("`{}`", brief_text(name));
        }
        entry
    }

    fn value(&self, key: &str) -> Option<&'a Spanned<Value>> {
        self.table.get_ref().iter().find(|(known, _)| known.get_ref() == key).map(|(_, value)| value)
    }

    /// Where a key stands; the entry's beginning if it is missing.
    pub fn place(&self, key: &str) -> Box<Place> {
        let offset = self.table.get_ref().keys().find(|known| known.get_ref() == key);
        let offset = offset.map_or(self.table.span().start, |known| known.span().start);
        Box::new(Place {
            file: self.file.to_owned(),
            line: line(self.text, offset),
            entry: self.name.clone(),
            key: brief_text(key).into_owned(),
        })
    }

    /// No other keys than these.
    pub fn has_only(&self, of: &str, known: &[&str]) -> Result<(), InputError> {
        match self.table.get_ref().keys().find(|key| !known.contains(&key.get_ref().as_str())) {
            None => Ok(()),
            Some(key) => Err(InputError::UnknownKey {
                place: self.place(key.get_ref()),
                of: of.to_owned(),
                suggestion: did_you_mean(key.get_ref(), known.iter().copied()),
                known: known.join(", "),
            }),
        }
    }

    pub fn has(&self, key: &str) -> bool {
        self.value(key).is_some()
    }

    /// A value that means nothing here.
    pub fn wrong(&self, key: &str, expected: impl Into<String>) -> InputError {
        self.wrong_name(key, String::new(), expected)
    }

    /// The same, with what may have been meant.
    pub fn wrong_name(&self, key: &str, suggestion: String, expected: impl Into<String>) -> InputError {
        let value = self.value(key).map_or(String::new(), |value| value.get_ref().to_string());
        let value = brief_text(&value).into_owned();
        InputError::WrongValue { place: self.place(key), value, suggestion, expected: expected.into() }
    }

    pub fn optional_text(&self, key: &str) -> Result<Option<&'a str>, InputError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let text = value.get_ref().as_str().filter(|text| !text.trim().is_empty());
        text.map(Some).ok_or_else(|| self.wrong(key, "a text in quotes, with something in it"))
    }

    pub fn text(&self, key: &str) -> Result<&'a str, InputError> {
        self.optional_text(key)?.ok_or_else(|| InputError::MissingKey { place: self.place(key) })
    }

    /// A text that is parsed.
    pub fn parsed<T: FromStr>(&self, key: &str, expected: &str) -> Result<T, InputError> {
        self.text(key)?.trim().parse().map_err(|_| self.wrong(key, expected))
    }

    pub fn flag(&self, key: &str) -> Result<bool, InputError> {
        let Some(value) = self.value(key) else { return Ok(false) };
        value.get_ref().as_bool().ok_or_else(|| self.wrong(key, "true or false"))
    }

    pub fn whole<T>(&self, key: &str, range: RangeInclusive<T>) -> Result<T, InputError>
    where
        T: TryFrom<i64> + PartialOrd + Display,
    {
        let value = self.value(key).ok_or_else(|| InputError::MissingKey { place: self.place(key) })?;
        let number = value.get_ref().as_integer().and_then(|number| T::try_from(number).ok());
        let expected =
            || self.wrong(key, format!("a whole number from {} to {}", range.start(), range.end()));
        number.filter(|number| range.contains(number)).ok_or_else(expected)
    }
}
