//! Named levels of quality.

use clap::ValueEnum;
use optics::Quality;
use serde::Deserialize;

/// How much time a picture may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum QualityPreset {
    /// Twice the step and half the detail: to look around.
    Draft,
    /// What the display can show.
    Default,
    /// Half the step and twice the detail: to check the default against.
    Fine,
}

impl QualityPreset {
    /// The knobs.
    pub fn quality(self) -> Quality {
        let default = Quality::default();
        match self {
            QualityPreset::Default => default,
            QualityPreset::Draft => Quality {
                step_voxels: 2.0 * default.step_voxels,
                tolerance: 16.0 * default.tolerance,
                termination: 8.0 * default.termination,
                lod_scale: 2.0 * default.lod_scale,
                ..default
            },
            QualityPreset::Fine => Quality {
                step_voxels: 0.5 * default.step_voxels,
                tolerance: default.tolerance / 16.0,
                termination: default.termination / 8.0,
                lod_scale: 0.5 * default.lod_scale,
                ..default
            },
        }
    }
}
