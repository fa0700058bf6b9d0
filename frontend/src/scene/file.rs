//! A scene file as TOML has it, before it is checked.

use super::{LookName, QualityPreset, ToolKind, VolumeAxis};
use display_config::text::ListOf;
use optics::{ExtinctionUnit, MimdaForm};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

/// A key that is given, with the place of its value.
pub(super) type Key = (&'static str, Range<usize>);

/// The key, where it is given.
pub(super) fn key<T>(name: &'static str, value: &Option<Spanned<T>>) -> Option<Key> {
    value.as_ref().map(|value| (name, value.span()))
}

/// A number with its place in the file.
pub(super) type Number = Spanned<f64>;
/// A point or direction with its place in the file.
pub(super) type Triple = Spanned<ListOf<f64, 3>>;
/// A lower and an upper limit with their place in the file.
pub(super) type Limits = Spanned<ListOf<f64, 2>>;
/// Control points, each `[value, numbers…]`, with their places.
pub(super) type Points = Spanned<Vec<Spanned<Vec<f64>>>>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub name: Option<String>,
    pub look: Option<Spanned<LookName>>,
    pub volume: VolumeTable,
    pub placement: Option<Spanned<PlacementTable>>,
    pub optics: Option<OpticsTable>,
    pub mimda: Option<Spanned<MimdaTable>>,
    #[serde(default)]
    pub band: Vec<BandTable>,
    #[serde(default)]
    pub enhancer: Vec<EnhancerTable>,
    pub light: Option<LightTable>,
    #[serde(default)]
    pub display: DisplayTable,
    #[serde(default)]
    pub quality: QualityTable,
    #[serde(default)]
    pub keyframe: Vec<KeyframeTable>,
    #[serde(default)]
    pub frames: FramesTable,
    pub tool: Option<ToolTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VolumeTable {
    pub source: Spanned<String>,
    pub size: Option<Spanned<Voxels>>,
    pub voxel_size_m: Option<Spanned<Lengths>>,
}

/// Voxels along all axes, or along each.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "give a whole number of voxels, or three of them")]
pub(super) enum Voxels {
    All(u32),
    Each(ListOf<u32, 3>),
}

/// A length along all axes, or along each.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "give a number of metres, or three of them")]
pub(super) enum Lengths {
    All(f64),
    Each(ListOf<f64, 3>),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlacementTable {
    pub centre_m: Option<Triple>,
    pub rotation_deg: Option<Triple>,
    pub longest_m: Option<Number>,
    pub scale: Option<Number>,
    pub up: Option<Spanned<VolumeAxis>>,
    pub front: Option<Spanned<VolumeAxis>>,
    pub right: Option<Spanned<VolumeAxis>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OpticsTable {
    pub domain: Option<Limits>,
    pub extinction_unit: ExtinctionUnit,
    pub extinction: Points,
    pub colour: Points,
    pub importance: Option<Points>,
    pub refraction: Option<Points>,
    pub materials: Option<Points>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MimdaTable {
    pub gamma: Number,
    pub form: Option<MimdaForm>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    pub toward: Option<Triple>,
    pub ambient: Option<Number>,
    pub diffuse: Option<Number>,
    pub specular: Option<Number>,
    pub shininess: Option<Number>,
    pub gradient_half: Option<Number>,
    pub detail: Option<Spanned<DetailKind>>,
    pub detail_strength: Option<Number>,
}

/// See [`optics::Detail`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum DetailKind {
    None,
    Unsharp,
    Exaggerated,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BandTable {
    pub name: Spanned<String>,
    pub corners: Spanned<ListOf<f64, 4>>,
}

/// The keys of all kinds of enhancers; which of them a kind has is checked later.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnhancerTable {
    pub kind: Spanned<optics::EnhancerKind>,
    pub carried: Option<Spanned<bool>>,
    pub band: Option<Spanned<String>>,
    pub point_m: Option<Triple>,
    pub normal: Option<Triple>,
    pub context: Option<Limits>,
    pub thickness_m: Option<Number>,
    pub boost: Option<Number>,
    pub centre_m: Option<Triple>,
    pub radius_m: Option<Number>,
    pub axis: Option<Triple>,
    pub facing: Option<Limits>,
    pub gradient_most: Option<Number>,
    pub edges: Option<Limits>,
    pub away: Option<Number>,
    pub toward: Option<Number>,
    pub strength: Option<Number>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DisplayTable {
    pub eta: Option<Number>,
    pub observer_m: Option<Triple>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QualityTable {
    pub preset: Option<QualityPreset>,
    pub step_voxels: Option<Number>,
    pub tolerance: Option<Number>,
    pub termination: Option<Number>,
    pub lod_scale: Option<Number>,
    pub quadrilinear: Option<bool>,
    /// See [`optics::Quality::deviation`].
    pub deviation: Option<bool>,
    pub blended: Option<bool>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyframeTable {
    pub time_s: Number,
    pub observer_m: Option<Triple>,
    pub centre_m: Option<Triple>,
    pub rotation_deg: Option<Triple>,
    pub tool_tip_m: Option<Triple>,
    pub tool_axis: Option<Triple>,
    pub extinction: Option<Points>,
    pub colour: Option<Points>,
    pub importance: Option<Points>,
    pub refraction: Option<Points>,
    pub gamma: Option<Number>,
    pub pick: Option<Spanned<String>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FramesTable {
    pub count: Option<Spanned<u32>>,
    pub rate_hz: Option<Number>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ToolTable {
    pub kind: ToolKind,
    pub tip_m: Option<Triple>,
    pub axis: Option<Triple>,
}
