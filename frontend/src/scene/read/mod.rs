//! From a scene file's text to a checked scene.

mod enhancer;
mod light;
mod motion;
mod optics;
mod volume;

use super::error::Checked;
use super::file::{DisplayTable, FramesTable, SceneFile, ToolTable};
use super::text::SceneText;
use super::{Look, LookWish, Scene, SceneEnhancer, SceneError, Tool, VolumeSource, WishedLook, builtin};
use ::optics::Enhancer;
use display_config::text::read_text;
use glam::DVec3;
use motion::Changeable;
use std::path::Path;

/// Frames per second: times of frames stay numbers.
const RATES_HZ: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Reads a scene file; its volume must be there.
pub(super) fn scene_from_file(path: &Path) -> Checked<Scene> {
    let scene = scene_without_volume(path)?;
    match &scene.volume {
        VolumeSource::Store(store) if !store.is_file() => {
            Err(SceneError::NoStore { place: scene.source_place, path: store.clone() })
        }
        _ => Ok(scene),
    }
}

/// Reads a scene file, whether its volume is there or not.
pub(super) fn scene_without_volume(path: &Path) -> Checked<Scene> {
    let read = |source| SceneError::Read { path: path.to_owned(), source };
    let text = SceneText { file: path.display().to_string(), text: read_text(path).map_err(read)? };
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    scene_from_text(&text, &name, path.parent().unwrap_or(Path::new("")))
}

/// The scene of a text; stores are looked for from `folder`.
pub(super) fn scene_from_text(text: &SceneText, name: &str, folder: &Path) -> Checked<Scene> {
    let file: SceneFile = toml::from_str(&text.text).map_err(|e| text.not_readable(&e))?;
    let volume = text.volume(&file.volume, folder)?;
    let still = builtin::default_scene(volume);
    let tool = file.tool.as_ref().map(|tool| text.tool(tool)).transpose()?;
    let look = text.look(&file)?;
    let bands = text.bands(&file.band)?;
    let enhancers = text.enhancers(&file.enhancer, &bands, tool.is_some())?;
    let (motion, edits) = text.motion(
        &file.keyframe,
        &Changeable {
            look: look.as_ref(),
            bands: &bands,
            has_tool: tool.is_some(),
            has_picker: enhancers.iter().any(is_picker),
        },
    )?;
    Ok(Scene {
        name: file.name.clone().unwrap_or_else(|| name.to_owned()),
        voxel_size_m: file.volume.voxel_size_m.as_ref().map(|v| text.voxel_size(v)).transpose()?,
        placement: file.placement.as_ref().map_or(Ok(still.placement), |p| text.placement(p))?,
        wish: text.wish(&file, still.wish)?,
        look: look.map_or(still.look, Look::InDataUnits),
        bands,
        enhancers,
        light: file.light.as_ref().map(|light| text.light(light)).transpose()?,
        source_place: Some(text.place(file.volume.source.span())),
        quality: text.quality(&file.quality)?,
        eta: file.display.eta.as_ref().map(|eta| text.within(eta, 0.0..=1.0)).transpose()?,
        observer_m: text.observer(&file.display)?,
        tool,
        motion,
        edits,
        frame_count: text.frame_count(&file.frames)?,
        rate_hz: file
            .frames
            .rate_hz
            .as_ref()
            .map_or(Ok(still.rate_hz), |rate| text.within(rate, RATES_HZ))?,
        volume: still.volume,
    })
}

fn is_picker(enhancer: &SceneEnhancer) -> bool {
    matches!(enhancer.numbers, Enhancer::BandPicker(_))
}

impl SceneText {
    /// Where the look is to come from, if the file does not say what `otherwise` does.
    fn wish(&self, file: &SceneFile, otherwise: LookWish) -> Checked<LookWish> {
        let look = match (&file.look, &file.optics) {
            (Some(name), Some(_)) => {
                return Err(self.wrong(name.span(), "the scene has [optics] too; keep one of the two"));
            }
            (Some(name), None) => WishedLook::Named(*name.get_ref()),
            (None, Some(_)) => WishedLook::Own,
            (None, None) => otherwise.look,
        };
        // Only a look of the library brings a light.
        Ok(LookWish { look, keeps_light: file.light.is_some() })
    }

    fn observer(&self, table: &DisplayTable) -> Checked<Option<DVec3>> {
        table.observer_m.as_ref().map(|observer| self.before_screen(observer)).transpose()
    }

    fn tool(&self, table: &ToolTable) -> Checked<Tool> {
        let rest = Tool::at_rest(table.kind);
        let tip = self.optional_point(&table.tip_m)?;
        let axis = table.axis.as_ref().map(|axis| self.direction(axis)).transpose()?;
        Ok(Tool {
            tip_in_display: tip.unwrap_or(rest.tip_in_display),
            axis_in_display: axis.unwrap_or(rest.axis_in_display),
            ..rest
        })
    }

    fn frame_count(&self, table: &FramesTable) -> Checked<u32> {
        match &table.count {
            Some(count) if *count.get_ref() == 0 => {
                Err(self.wrong(count.span(), "it is 0; give at least 1 frame"))
            }
            Some(count) => Ok(*count.get_ref()),
            None => Ok(1),
        }
    }
}
