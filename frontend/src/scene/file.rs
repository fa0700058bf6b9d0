//! A scene file as TOML has it, before it is checked.

use super::{QualityPreset, VolumeAxis};
use backend::protocol::ToolKind;
use serde::Deserialize;
use shaders::optics::{ExtinctionUnit, MimdaForm};
use toml::Spanned;

/// A number with its place in the file.
pub(super) type Number = Spanned<f64>;
/// A point or direction with its place in the file.
pub(super) type Triple = Spanned<[f64; 3]>;
/// Control points, each `[value, numbers…]`, with their places.
pub(super) type Points = Spanned<Vec<Spanned<Vec<f64>>>>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub name: Option<String>,
    pub volume: VolumeTable,
    pub placement: Option<Spanned<PlacementTable>>,
    pub optics: Option<OpticsTable>,
    pub mimda: Option<Spanned<MimdaTable>>,
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
    Each([u32; 3]),
}

/// A length along all axes, or along each.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "give a number of metres, or three of them")]
pub(super) enum Lengths {
    All(f64),
    Each([f64; 3]),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlacementTable {
    pub centre_m: Option<Triple>,
    pub rotation_deg: Option<Triple>,
    pub longest_m: Option<Number>,
    pub scale: Option<Number>,
    pub up: Option<Spanned<VolumeAxis>>,
    pub front: Option<VolumeAxis>,
    pub right: Option<VolumeAxis>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OpticsTable {
    pub domain: Option<Spanned<[f64; 2]>>,
    pub extinction_unit: ExtinctionUnit,
    pub extinction: Points,
    pub colour: Points,
    pub importance: Option<Points>,
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
