//! The tool of a scene.

use glam::DVec3;
use serde::Deserialize;

/// What a scene's tool does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToolKind {
    /// It only points.
    Pointer,
    /// It carries the light: light comes from where the tool's axis points back to.
    Light,
}

/// A tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tool {
    /// What it does.
    pub kind: ToolKind,
    /// Its tip, display frame, metres.
    pub tip_in_display: DVec3,
    /// Unit vector along which it points, display frame.
    pub axis_in_display: DVec3,
}

impl Tool {
    /// One that nothing has moved: before the screen, pointing at it.
    pub(super) fn at_rest(kind: ToolKind) -> Self {
        Self { kind, tip_in_display: DVec3::new(0.0, 0.0, 0.5), axis_in_display: DVec3::NEG_Z }
    }
}
