//! How the picture of a projector is finished: the keys, and the files that they name.

mod map;
mod mesh;
mod number;
mod transfer;

use super::raw::RawFinish;
use super::source::Source;
use crate::finish::{BlackLevel, Finish, LightMap, MapFault, Transfer};
use crate::{ConfigError, text::brief_text};
use number::number;
use std::path::{Path, PathBuf};
use toml::{Spanned, Value};

/// A level of black, as messages ask for it.
const A_LEVEL: &str = "a number of linear light from 0 to 0.5, or three of them";
/// More is no level of black any more.
const MOST_BLACK: f64 = 0.5;

/// The stages of a projector, those that change nothing left out.
pub(super) fn finish(source: &Source<'_>, raw: Option<&RawFinish>) -> Result<Finish, ConfigError> {
    let Some(raw) = raw else { return Ok(Finish::default()) };
    let changes = |map: &LightMap| map.shares().iter().any(|&share| share != u16::MAX);
    Ok(Finish {
        mesh: raw.mesh.as_ref().map(|name| source.file_of("mesh", name, mesh::read)).transpose()?,
        blend: raw
            .blend
            .as_ref()
            .map(|name| source.file_of("blend", name, map::read))
            .transpose()?
            .filter(changes),
        black: raw.black_level.as_ref().map(|level| black(source, level)).transpose()?.filter(lifts),
        transfer: raw
            .transfer
            .as_ref()
            .map_or(Ok(Transfer::Srgb), |value| transfer::transfer(source, value))?,
        is_dithered: raw.dither.unwrap_or(false),
    })
}

fn lifts(black: &BlackLevel) -> bool {
    match black {
        BlackLevel::Level(level) => level.iter().any(|&channel| channel != 0.0),
        BlackLevel::Map(map) => map.shares().iter().any(|&share| share != 0),
    }
}

/// A number, three numbers, or the name of a map.
fn black(source: &Source<'_>, value: &Spanned<Value>) -> Result<BlackLevel, ConfigError> {
    let key = "black_level";
    if let Value::String(name) = value.get_ref() {
        let name = Spanned::new(value.span(), name.clone());
        return Ok(BlackLevel::Map(source.file_of(key, &name, map::read)?));
    }
    let numbers = match value.get_ref() {
        Value::Array(three) if three.len() == 3 => three.iter().map(number).collect::<Option<Vec<_>>>(),
        one => number(one).map(|level| vec![level; 3]),
    };
    let Some(numbers) = numbers else {
        return Err(source.wrong_value(
            key,
            value.span(),
            &format!("expected {A_LEVEL}, or the name of a map"),
        ));
    };
    match numbers.iter().find(|level| !(0.0..=MOST_BLACK).contains(*level)) {
        Some(&wrong) if wrong.is_finite() => Err(source.out_of_range(key, value.span(), wrong, A_LEVEL)),
        Some(_) => Err(ConfigError::NotFinite { place: source.place(key, value.span()) }),
        None => Ok(BlackLevel::Level(std::array::from_fn(|channel| numbers[channel] as f32))),
    }
}

impl Source<'_> {
    /// What `read` makes of the file that a key names, relative to the display's own.
    fn file_of<T>(
        &self,
        key: &str,
        name: &Spanned<String>,
        read: impl FnOnce(&Path) -> Result<T, MapFault>,
    ) -> Result<T, ConfigError> {
        let path = self.folder.join(self.name(key, name)?);
        read(&path).map_err(|fault| ConfigError::Map {
            place: self.place(key, name.span()),
            path: PathBuf::from(brief_text(&path.to_string_lossy()).into_owned()),
            fault,
        })
    }
}

#[cfg(test)]
mod tests;
