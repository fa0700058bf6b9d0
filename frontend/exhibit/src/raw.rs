//! The entries of an exhibit file.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toml::{Spanned, Value};

/// The file, each entry still as it stands, so that one that is wrong does not hide the others.
#[derive(Debug, Deserialize)]
#[serde(expecting = "a table")]
pub struct RawFile {
    pub title: Option<String>,
    pub display: Option<String>,
    pub inputs: Option<Spanned<PathBuf>>,
    pub rate_hz: Option<f64>,
    pub quality: Option<String>,
    #[serde(default)]
    pub item: Vec<Spanned<Value>>,
    #[serde(default)]
    pub visitor: Vec<Spanned<Value>>,
    #[serde(default)]
    pub tool: Vec<Spanned<Value>>,
    pub idle: Option<Spanned<Value>>,
    pub limits: Option<Spanned<Value>>,
    pub tape: Option<Spanned<Value>>,
    pub marks: Option<Spanned<Value>>,
}

/// The keys of the file.
pub const KEYS: [&str; 12] = [
    "title", "display", "inputs", "rate_hz", "quality", "item", "visitor", "tool", "idle", "limits", "tape",
    "marks",
];

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawItem {
    pub title: Option<String>,
    pub scene: String,
    pub looks: Option<RawLooks>,
    pub time_s: Option<f64>,
    #[serde(default)]
    pub preset: Vec<RawPreset>,
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "\"all\" or a list of looks")]
pub enum RawLooks {
    Word(String),
    List(Vec<String>),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawPreset {
    pub title: Option<String>,
    pub turn_deg: Option<[f64; 2]>,
    pub shift_m: Option<[f64; 3]>,
    pub scale: Option<f64>,
    pub look: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawVisitor {
    pub name: String,
    pub colour: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawTool {
    pub name: String,
    pub visitor: String,
    pub input: Option<String>,
    pub sensor: Option<u8>,
    pub kinds: Vec<world::ToolKind>,
    #[serde(default)]
    pub buttons: BTreeMap<String, world::Action>,
    #[serde(default)]
    pub dials: Vec<RawDial>,
    pub tip: Option<RawTip>,
    pub filter: Option<RawFilter>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawDial {
    pub axis: u8,
    pub does: world::DialKind,
    pub per_s: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawTip {
    pub translation_m: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawFilter {
    pub least_cutoff_hz: Option<f64>,
    pub cutoff_per_speed: Option<f64>,
    pub turn_least_cutoff_hz: Option<f64>,
    pub turn_cutoff_per_speed: Option<f64>,
    pub smoothing_ms: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawIdle {
    pub undone_after_s: Option<f64>,
    pub attract_after_s: Option<f64>,
    pub turn_deg_per_s: Option<f64>,
    pub caption: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawLimits {
    pub scales: Option<[f64; 2]>,
    pub farthest_m: Option<f64>,
    pub longest_hold_s: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawMarks {
    pub tools: Option<bool>,
    pub names: Option<bool>,
    pub captions: Option<bool>,
    pub depth_combined: Option<bool>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawTape {
    pub folder: PathBuf,
    pub part_mb: Option<u64>,
    pub keep_parts: Option<usize>,
}
