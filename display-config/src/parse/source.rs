//! The text of a display file, which knows the line of each value.

use super::raw::RawDisplay;
use crate::raster::{MOST_PIXELS, MOST_PIXELS_ALONG};
use crate::text::{ListOf, brief_text, did_you_mean, with_suggestion};
use crate::{ConfigError, Place};
use glam::DVec3;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// Nothing of a display is longer, or farther away, metres.
const FARTHEST_M: f64 = 1e6;

pub(super) struct Source<'a> {
    pub text: &'a str,
    /// What messages call it.
    pub file: &'a str,
    /// Where the files lie that it names.
    pub folder: &'a Path,
}

impl Source<'_> {
    /// The keys and values, each of the right type, none missing, none unknown.
    pub fn read(&self) -> Result<RawDisplay, ConfigError> {
        // Parsing without a schema separates text that is not TOML at all from text with the wrong keys.
        if let Err(error) = self.text.parse::<toml::Table>() {
            let line = self.line(error.span().map_or(0, |span| span.start));
            let message = brief_text(&error.message().replace('\n', ", ")).into_owned();
            return Err(ConfigError::Syntax { file: self.file.to_owned(), line, message });
        }
        toml::from_str(self.text).map_err(|error| self.rephrase(&error))
    }

    pub fn place(&self, key: &str, span: Range<usize>) -> Place {
        let key = brief_text(key).into_owned();
        Place { file: self.file.to_owned(), line: self.line(span.start), key }
    }

    pub fn finite(&self, key: &str, value: &Spanned<f64>) -> Result<f64, ConfigError> {
        self.all_finite(key, value.span(), &[*value.get_ref()])?;
        Ok(*value.get_ref())
    }

    pub fn all_finite(&self, key: &str, span: Range<usize>, values: &[f64]) -> Result<(), ConfigError> {
        let finite = values.iter().all(|value| value.is_finite());
        if finite { Ok(()) } else { Err(ConfigError::NotFinite { place: self.place(key, span) }) }
    }

    pub fn positive(
        &self,
        key: &str,
        value: &Spanned<f64>,
        expected: &'static str,
    ) -> Result<f64, ConfigError> {
        self.within(key, value, expected, |number| number > 0.0 && number <= FARTHEST_M)
    }

    /// A point of the display frame.
    pub fn point(&self, key: &str, value: &Spanned<ListOf<f64, 3>>) -> Result<DVec3, ConfigError> {
        let coordinates = value.get_ref().0;
        self.all_finite(key, value.span(), &coordinates)?;
        match coordinates.into_iter().find(|coordinate| coordinate.abs() > FARTHEST_M) {
            Some(far) => {
                let expected = "coordinates from -1000000 to 1000000 metres";
                Err(self.out_of_range(key, value.span(), far, expected))
            }
            None => Ok(DVec3::from_array(coordinates)),
        }
    }

    pub fn within(
        &self,
        key: &str,
        value: &Spanned<f64>,
        expected: &'static str,
        accepts: impl Fn(f64) -> bool,
    ) -> Result<f64, ConfigError> {
        let number = self.finite(key, value)?;
        if accepts(number) { Ok(number) } else { Err(self.out_of_range(key, value.span(), number, expected)) }
    }

    pub fn at_least_one(
        &self,
        key: &str,
        value: &Spanned<u32>,
        expected: &'static str,
    ) -> Result<u32, ConfigError> {
        match *value.get_ref() {
            0 => Err(self.out_of_range(key, value.span(), 0.0, expected)),
            number => Ok(number),
        }
    }

    /// Pixels along x and y.
    pub fn raster_size(
        &self,
        width_px: &Spanned<u32>,
        height_px: &Spanned<u32>,
    ) -> Result<(u32, u32), ConfigError> {
        let expected = "a number of pixels from 1 to 16384";
        let along = |key, pixels: &Spanned<u32>| match *pixels.get_ref() {
            count if (1..=MOST_PIXELS_ALONG).contains(&count) => Ok(count),
            count => Err(self.out_of_range(key, pixels.span(), f64::from(count), expected)),
        };
        let (width, height) = (along("width_px", width_px)?, along("height_px", height_px)?);
        if u64::from(width) * u64::from(height) > u64::from(MOST_PIXELS) {
            let place = self.place("height_px", height_px.span());
            return Err(ConfigError::TooManyPixels { place, width, height });
        }
        Ok((width, height))
    }

    pub fn name(&self, key: &str, value: &Spanned<String>) -> Result<String, ConfigError> {
        if value.get_ref().trim().is_empty() {
            return Err(ConfigError::EmptyName { place: self.place(key, value.span()) });
        }
        Ok(value.get_ref().clone())
    }

    /// A projector's centre: finite, and not in the screen plane.
    pub fn centre(&self, key: &str, value: &Spanned<ListOf<f64, 3>>) -> Result<DVec3, ConfigError> {
        let centre = self.point(key, value)?;
        if centre.z == 0.0 {
            return Err(ConfigError::ProjectorInScreenPlane { place: self.place(key, value.span()) });
        }
        Ok(centre)
    }

    pub fn out_of_range(
        &self,
        key: &str,
        span: Range<usize>,
        value: f64,
        expected: &'static str,
    ) -> ConfigError {
        ConfigError::OutOfRange { place: self.place(key, span), value, expected }
    }

    /// A value of another type than the key's, or not among its choices.
    pub fn wrong_value(&self, key: &str, span: Range<usize>, message: &str) -> ConfigError {
        ConfigError::WrongType { place: self.place(key, span), message: message.to_owned() }
    }

    fn line(&self, offset: usize) -> usize {
        1 + self.text.bytes().take(offset).filter(|&byte| byte == b'\n').count()
    }

    /// The parser's message about keys and types, with its file, line and key, and what to do.
    fn rephrase(&self, error: &toml::de::Error) -> ConfigError {
        let span = error.span().unwrap_or(0..0);
        let message = error.message();
        if let Some((key, rest)) = quoted_after(message, "unknown field `") {
            let known = rest.trim_start_matches(", expected ").replacen("one of ", "", 1);
            let suggestion = did_you_mean(key, known.split('`').skip(1).step_by(2));
            return ConfigError::UnknownKey { place: self.place(key, span), suggestion, known };
        }
        if let Some((key, _)) = quoted_after(message, "missing field `") {
            return ConfigError::MissingKey { place: self.place(key, span) };
        }
        let key = self.header_at(span.start).unwrap_or_else(|| self.key_before(span.start));
        let message = with_suggestion(message).replace("expected f64", "expected a number");
        let message = message.replace("expected u32", "expected a whole number, 0 or more");
        ConfigError::WrongType { place: self.place(key, span), message }
    }

    /// The name of the table whose header, `[name]` or `[[name]]`, an offset lies in.
    fn header_at(&self, offset: usize) -> Option<&str> {
        let line = self.text.lines().nth(self.line(offset) - 1)?.trim_start();
        let (name, _) = line.strip_prefix('[')?.trim_start_matches('[').split_once(']')?;
        let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        let named = name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(is_bare);
        named.then_some(name)
    }

    /// The key whose value an offset lies in: what stands before the last `=` up to it.
    fn key_before(&self, offset: usize) -> &str {
        let before = self.text.get(..offset).unwrap_or(self.text);
        let key = before.rsplit_once('=').map_or("", |(before_sign, _)| before_sign.trim_end());
        key.rsplit(['\n', '{', ',']).next().unwrap_or(key).trim()
    }
}

/// What a message quotes after a prefix, and the rest of the message.
fn quoted_after<'m>(message: &'m str, prefix: &str) -> Option<(&'m str, &'m str)> {
    message.strip_prefix(prefix)?.split_once('`')
}
