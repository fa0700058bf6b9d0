//! The light and the quality in a scene file.

use crate::scene::error::Checked;
use crate::scene::file::{DetailKind, LightTable, QualityTable, key};
use crate::scene::text::SceneText;
use ::optics::{Detail, Light, Quality};

/// Of unsharp masking: as much again as a level differs from the next coarser one.
const UNSHARP_STRENGTH: f64 = 1.0;
/// Of exaggerated shading: half-lit slopes count as fully lit.
const EXAGGERATED_CONTRAST: f64 = 2.0;
/// Numbers above 0.
const ABOVE_ZERO: std::ops::RangeInclusive<f64> = f64::MIN_POSITIVE..=f64::MAX;
/// Numbers of at least 0.
const AT_LEAST_ZERO: std::ops::RangeInclusive<f64> = 0.0..=f64::MAX;

impl SceneText {
    pub(super) fn light(&self, table: &LightTable) -> Checked<Light> {
        let default = Light::default();
        let toward = table.toward.as_ref().map(|t| self.direction(t)).transpose()?;
        let light = Light {
            toward_light_in_display: toward.unwrap_or(default.toward_light_in_display),
            ambient: self.within_or(&table.ambient, default.ambient, AT_LEAST_ZERO)?,
            diffuse: self.within_or(&table.diffuse, default.diffuse, AT_LEAST_ZERO)?,
            specular: self.within_or(&table.specular, default.specular, AT_LEAST_ZERO)?,
            shininess: self.within_or(&table.shininess, default.shininess, 1.0..=f64::MAX)?,
            gradient_half: self.within_or(&table.gradient_half, default.gradient_half, ABOVE_ZERO)?,
            detail: self.detail(table)?,
        };
        let keys = [
            key("ambient", &table.ambient),
            key("diffuse", &table.diffuse),
            key("specular", &table.specular),
            key("shininess", &table.shininess),
            key("gradient_half", &table.gradient_half),
            key("detail_strength", &table.detail_strength),
        ];
        self.within_bounds(light.check(), keys.into_iter().flatten(), 0..0)?;
        Ok(light)
    }

    fn detail(&self, table: &LightTable) -> Checked<Detail> {
        let kind = table.detail.as_ref().map_or(DetailKind::None, |kind| *kind.get_ref());
        let strength = |otherwise| self.within_or(&table.detail_strength, otherwise, AT_LEAST_ZERO);
        match (kind, &table.detail_strength) {
            (DetailKind::None, Some(strength)) => {
                let message =
                    "it does nothing without detail = \"unsharp\" or \"exaggerated\"; add one of them";
                Err(self.wrong(strength.span(), message))
            }
            (DetailKind::None, None) => Ok(Detail::None),
            (DetailKind::Unsharp, _) => Ok(Detail::Unsharp { strength: strength(UNSHARP_STRENGTH)? }),
            (DetailKind::Exaggerated, _) => {
                Ok(Detail::Exaggerated { contrast: strength(EXAGGERATED_CONTRAST)? })
            }
        }
    }

    pub(super) fn quality(&self, table: &QualityTable) -> Checked<Quality> {
        let preset = table.preset.map_or(Quality::default(), |preset| preset.quality());
        let (shortest, longest) = Quality::STEPS_VOXELS;
        let quality = Quality {
            step_voxels: self.within_or(&table.step_voxels, preset.step_voxels, shortest..=longest)?,
            tolerance: self.within_or(
                &table.tolerance,
                preset.tolerance,
                Quality::LEAST_TOLERANCE..=f64::MAX,
            )?,
            termination: self.within_or(&table.termination, preset.termination, 0.0..=1.0)?,
            lod_scale: self.within_or(&table.lod_scale, preset.lod_scale, AT_LEAST_ZERO)?,
            quadrilinear: table.quadrilinear.unwrap_or(preset.quadrilinear),
            deviation: table.deviation.unwrap_or(preset.deviation),
            blended: table.blended.unwrap_or(preset.blended),
        };
        self.within_bounds(quality.check(), key("lod_scale", &table.lod_scale), 0..0)?;
        Ok(quality)
    }
}
