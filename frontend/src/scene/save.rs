//! A scene as the text of a scene file.

use super::names::PROCEDURAL_PREFIX;
use super::text::SceneText;
use super::{DataLook, Look, Scene, SceneError, VolumeSource};
use crate::same_file::is_same_file;
use display_config::text::read_text;
use glam::DVec3;
use optics::{Curve, CurveValue, Detail, ExtinctionUnit, Light, Quality};
use std::path::{Path, PathBuf, absolute};
use toml::{Table, Value};

impl Scene {
    /// The scene of a command-line argument as the text of a file at `out`, with the look and quality that it has now: read
    /// back, it makes the same frames. What its own file says stays word for word, but for the comments.
    ///
    /// # Errors
    /// A file that cannot be read again, is the one to be written, or whose volume has no name in UTF-8.
    pub fn saved(&self, argument: &str, out: &Path) -> Result<String, SceneError> {
        let is_toml = |path: &Path| path.extension().is_some_and(|ending| ending == "toml");
        if !is_toml(out) {
            return Err(SceneError::SavedName { path: out.to_owned() });
        }
        let own = Path::new(argument);
        let mut table = Table::new();
        if !argument.starts_with(PROCEDURAL_PREFIX) && is_toml(own) {
            if is_same_file(own, out) {
                return Err(SceneError::SavedOverItself { path: out.to_owned() });
            }
            table = read_table(own)?;
        }
        table.entry("name").or_insert_with(|| self.name.clone().into());
        self.save_volume(&mut table, out)?;
        self.save_look(&mut table);
        table.remove("quality");
        if self.quality != Quality::default() {
            table.insert("quality".into(), quality(&self.quality).into());
        }
        Ok(table.to_string())
    }

    fn save_volume(&self, table: &mut Table, out: &Path) -> Result<(), SceneError> {
        let volume = table.entry("volume").or_insert_with(|| Table::new().into());
        let Value::Table(volume) = volume else { return Ok(()) };
        let source = match &self.volume {
            VolumeSource::Store(path) => name_beside(path, out)?,
            VolumeSource::Procedural { name, dims } => {
                let size: Vec<Value> = dims.to_array().map(|n| i64::from(n).into()).into();
                volume.insert("size".into(), size.into());
                format!("{PROCEDURAL_PREFIX}{name}")
            }
        };
        volume.insert("source".into(), source.into());
        Ok(())
    }

    /// A look and a light that the file does not have itself. A built-in look stays with its volume.
    fn save_look(&self, table: &mut Table) {
        table.remove("look");
        if let (Look::InDataUnits(look), false) = (&self.look, table.contains_key("optics")) {
            table.insert("optics".into(), optics(look).into());
        }
        if let (Some(own), false) = (&self.light, table.contains_key("light")) {
            table.insert("light".into(), light(own).into());
        }
    }
}

fn read_table(path: &Path) -> Result<Table, SceneError> {
    let text = read_text(path).map_err(|source| SceneError::Read { path: path.to_owned(), source })?;
    let text = SceneText { file: path.display().to_string(), text };
    text.text.parse().map_err(|error| text.not_readable(&error))
}

/// The volume's name as a scene file at `out` gives it: short beside it, whole elsewhere.
fn name_beside(path: &Path, out: &Path) -> Result<String, SceneError> {
    let folder = |path: &Path| folder_of(path).canonicalize().ok();
    let name = match path.file_name() {
        Some(name) if folder(path).is_some() && folder(path) == folder(out) => PathBuf::from(name),
        _ => path.canonicalize().or_else(|_| absolute(path)).unwrap_or_else(|_| path.to_owned()),
    };
    let unnamed = || SceneError::SavedVolume { path: path.to_owned() };
    // What begins like a procedural volume would be read as one.
    let is_plain = |name: &&str| !name.starts_with(PROCEDURAL_PREFIX);
    name.to_str().filter(is_plain).map(str::to_owned).ok_or_else(unnamed)
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn optics(look: &DataLook) -> Table {
    let unit = match look.extinction_unit {
        ExtinctionUnit::PerMetre => "per_metre",
        ExtinctionUnit::PerVoxel => "per_voxel",
    };
    let mut table = Table::new();
    if let Some((low, high)) = look.domain {
        table.insert("domain".into(), vec![low, high].into());
    }
    table.insert("extinction_unit".into(), unit.into());
    table.insert("extinction".into(), points(&look.extinction, |value| vec![value]));
    table.insert("colour".into(), points(&look.colour, |rgb: DVec3| rgb.to_array().into()));
    table
}

fn points<V: CurveValue>(curve: &Curve<V>, numbers: impl Fn(V) -> Vec<f64>) -> Value {
    let point = |&(value, v): &(f64, V)| Value::from([vec![value], numbers(v)].concat());
    curve.points().iter().map(point).collect::<Vec<_>>().into()
}

fn light(light: &Light) -> Table {
    let mut table = Table::new();
    let toward = light.toward_light_in_display;
    // Brought to unit length once more, it might turn by a rounding.
    if toward != Light::default().toward_light_in_display {
        table.insert("toward".into(), toward.to_array().to_vec().into());
    }
    for (key, factor) in [
        ("ambient", light.ambient),
        ("diffuse", light.diffuse),
        ("specular", light.specular),
        ("shininess", light.shininess),
        ("gradient_half", light.gradient_half),
    ] {
        table.insert(key.into(), factor.into());
    }
    let detail = match light.detail {
        Detail::None => None,
        Detail::Unsharp { strength } => Some(("unsharp", strength)),
        Detail::Exaggerated { contrast } => Some(("exaggerated", contrast)),
    };
    if let Some((kind, strength)) = detail {
        table.insert("detail".into(), kind.into());
        table.insert("detail_strength".into(), strength.into());
    }
    table
}

fn quality(quality: &Quality) -> Table {
    let numbers = [
        ("step_voxels", quality.step_voxels),
        ("tolerance", quality.tolerance),
        ("termination", quality.termination),
        ("lod_scale", quality.lod_scale),
    ];
    let switches = [
        ("quadrilinear", quality.quadrilinear),
        ("deviation", quality.deviation),
        ("blended", quality.blended),
    ];
    let numbers = numbers.map(|(key, number)| (key.to_owned(), Value::from(number)));
    numbers.into_iter().chain(switches.map(|(key, is_on)| (key.to_owned(), is_on.into()))).collect()
}
