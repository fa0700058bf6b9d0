//! What a tape says of itself, and the files that go with it.

use serde::Serialize;
use std::collections::BTreeMap;

/// The version of tapes that this program writes.
pub const FORMAT: u32 = 1;
/// What the profile of a tape is called.
pub const PROFILE: &str = "lightloom";
/// What its metadata are called.
pub const METADATA: &str = "lightloom";

/// What stands at the beginning of a tape, and of each part of a long one.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Head {
    /// What is on it: a scene or an exhibit.
    pub show: String,
    /// The version of the program.
    pub version: String,
    /// When the display's clock began, nanoseconds since 1970.
    pub began_ns: u64,
    /// Sources of inputs, by their numbers.
    pub sources: Vec<String>,
    /// What else whoever plays it must know, by name.
    pub settings: BTreeMap<String, String>,
    /// Files that the show was made of.
    #[serde(skip)]
    pub files: Vec<AttachedFile>,
    /// Which part of a long tape it is, from 1.
    pub part: u32,
}

/// A file as it was when the show began.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AttachedFile {
    /// Its path.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

impl Head {
    /// The same as metadata.
    pub(crate) fn metadata(&self) -> mcap::records::Metadata {
        let mut metadata: BTreeMap<String, String> =
            self.settings.iter().map(|(key, value)| (format!("setting.{key}"), value.clone())).collect();
        let numbered = |(number, name): (usize, &String)| (format!("source.{number:05}"), name.clone());
        metadata.extend(self.sources.iter().enumerate().map(numbered));
        let own = [
            ("format", FORMAT.to_string()),
            ("show", self.show.clone()),
            ("version", self.version.clone()),
            ("began_ns", self.began_ns.to_string()),
            ("part", self.part.to_string()),
        ];
        metadata.extend(own.map(|(key, value)| (key.to_owned(), value)));
        mcap::records::Metadata { name: METADATA.to_owned(), metadata }
    }

    /// What metadata say, and the version of the tape; None where they are not a tape's.
    pub(crate) fn of(metadata: &BTreeMap<String, String>) -> Option<(u32, Self)> {
        let number = |key: &str| metadata.get(key)?.parse::<u64>().ok();
        let text = |key: &str| metadata.get(key).cloned().unwrap_or_default();
        let starting = |prefix: &'static str| {
            let named =
                metadata.iter().filter_map(move |(key, value)| Some((key.strip_prefix(prefix)?, value)));
            named.map(|(key, value)| (key.to_owned(), value.clone()))
        };
        let head = Self {
            show: text("show"),
            version: text("version"),
            began_ns: number("began_ns").unwrap_or(0),
            sources: starting("source.").map(|source| source.1).collect(),
            settings: starting("setting.").collect(),
            files: Vec::new(),
            part: number("part").and_then(|part| u32::try_from(part).ok()).unwrap_or(1),
        };
        Some((u32::try_from(number("format")?).ok()?, head))
    }
}
