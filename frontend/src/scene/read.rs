//! From a scene file's text to a checked scene.

use super::file::{
    DisplayTable, KeyframeTable, LightTable, OpticsTable, PlacementTable, QualityTable, SceneFile,
};
use super::file::{FramesTable, Lengths, MimdaTable, Number, Points, ToolTable, VolumeTable, Voxels};
use super::look::DataLook;
use super::motion::Direction;
use super::placement::rotation_from_deg;
use super::text::SceneText;
use super::volume::{LARGEST_EDGE, PROCEDURAL};
use super::{
    Look, Motion, Placement, Scene, SceneError, Size, VolumeAxes, VolumeAxis, VolumeSource, builtin,
};
use backend::protocol::Tool;
use glam::{DVec3, UVec3};
use shaders::optics::{Curve, CurveError, CurveValue, Light, Mimda, MimdaForm, Quality};
use std::ops::{Range, RangeInclusive};
use std::path::Path;
use toml::Spanned;

type Checked<T> = Result<T, SceneError>;

/// Reads a scene file; its volume must be there.
pub(super) fn scene_from_file(path: &Path) -> Checked<Scene> {
    let scene = scene_without_volume(path)?;
    match &scene.volume {
        VolumeSource::Store(store) if !store.is_file() => Err(SceneError::NoStore { path: store.clone() }),
        _ => Ok(scene),
    }
}

/// Reads a scene file, whether its volume is there or not.
pub(super) fn scene_without_volume(path: &Path) -> Checked<Scene> {
    let read = |source| SceneError::Read { path: path.to_owned(), source };
    let text =
        SceneText { file: path.display().to_string(), text: std::fs::read_to_string(path).map_err(read)? };
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    scene_from_text(&text, &name, path.parent().unwrap_or(Path::new("")))
}

/// The scene of a text; stores are looked for from `folder`.
pub(super) fn scene_from_text(text: &SceneText, name: &str, folder: &Path) -> Checked<Scene> {
    let file: SceneFile = toml::from_str(&text.text).map_err(|e| text.not_readable(&e))?;
    let volume = text.volume(&file.volume, folder)?;
    let still = builtin::default_scene(volume);
    let tool = file.tool.as_ref().map(|tool| text.tool(tool)).transpose()?;
    Ok(Scene {
        name: file.name.clone().unwrap_or_else(|| name.to_owned()),
        voxel_size_m: file.volume.voxel_size_m.as_ref().map(|v| text.voxel_size(v)).transpose()?,
        placement: file.placement.as_ref().map_or(Ok(still.placement), |p| text.placement(p))?,
        look: text.look(&file)?.unwrap_or(still.look),
        light: file.light.as_ref().map(|light| text.light(light)).transpose()?,
        quality: text.quality(&file.quality)?,
        eta: file.display.eta.as_ref().map(|eta| text.within(eta, 0.0..=1.0)).transpose()?,
        observer_m: text.observer(&file.display)?,
        motion: text.motion(&file.keyframe, tool.is_some())?,
        tool,
        frame_count: text.frame_count(&file.frames)?,
        rate_hz: file.frames.rate_hz.as_ref().map_or(Ok(still.rate_hz), |rate| text.above_zero(rate))?,
        volume: still.volume,
    })
}

impl SceneText {
    fn volume(&self, table: &VolumeTable, folder: &Path) -> Checked<VolumeSource> {
        let source = table.source.get_ref();
        let Some(name) = source.strip_prefix(PROCEDURAL) else {
            return match &table.size {
                Some(size) => Err(self.wrong(size.span(), "a store has its own size; remove this line")),
                None => Ok(VolumeSource::Store(folder.join(source))),
            };
        };
        let volume =
            VolumeSource::procedural(name).map_err(|e| self.wrong(table.source.span(), e.to_string()))?;
        let (Some(size), VolumeSource::Procedural { name, .. }) = (&table.size, &volume) else {
            return Ok(volume);
        };
        let dims = match *size.get_ref() {
            Voxels::All(edge) => UVec3::splat(edge),
            Voxels::Each(edges) => UVec3::from_array(edges),
        };
        if dims.min_element() < 1 || dims.max_element() > LARGEST_EDGE {
            return Err(self.wrong(size.span(), format!("give sizes from 1 to {LARGEST_EDGE} voxels")));
        }
        Ok(VolumeSource::Procedural { name: name.clone(), dims })
    }

    fn voxel_size(&self, lengths: &Spanned<Lengths>) -> Checked<DVec3> {
        let size = match *lengths.get_ref() {
            Lengths::All(edge) => DVec3::splat(edge),
            Lengths::Each(edges) => DVec3::from_array(edges),
        };
        let usable = size.is_finite() && size.min_element() > 0.0;
        usable.then_some(size).ok_or_else(|| self.wrong(lengths.span(), "give finite lengths above 0"))
    }

    fn placement(&self, table: &Spanned<PlacementTable>) -> Checked<Placement> {
        let place = table.get_ref();
        let size = match (&place.longest_m, &place.scale) {
            (Some(longest), None) => Size::LongestM(self.above_zero(longest)?),
            (None, Some(scale)) => Size::Scale(self.above_zero(scale)?),
            (Some(_), Some(scale)) => {
                return Err(self.wrong(scale.span(), "longest_m is given too; keep exactly one of the two"));
            }
            (None, None) => return Err(self.wrong(table.span(), "add exactly one of longest_m and scale")),
        };
        let centre_m = self.optional_point(&place.centre_m)?.unwrap_or(DVec3::ZERO);
        let deg = self.optional_point(&place.rotation_deg)?.unwrap_or(DVec3::ZERO);
        let axes = self.axes(place, table.span())?;
        Ok(Placement { centre_m, rotation: rotation_from_deg(deg), axes, size })
    }

    /// Which way the volume stands; None where the file leaves it to the volume.
    fn axes(&self, place: &PlacementTable, table: Range<usize>) -> Checked<Option<VolumeAxes>> {
        if place.up.is_none() && place.front.is_none() && place.right.is_none() {
            return Ok(None);
        }
        let up = place.up.as_ref().map_or(VolumeAxis::PlusY, |up| *up.get_ref());
        let span = place.up.as_ref().map_or(table, Spanned::span);
        let axes = VolumeAxes::new(up, place.front.unwrap_or(VolumeAxis::PlusZ), place.right);
        let message = "up, front and right must be three different axes of the volume";
        axes.map(Some).ok_or_else(|| self.wrong(span, message))
    }

    /// The look of the file; None where it leaves it to the volume.
    fn look(&self, file: &SceneFile) -> Checked<Option<Look>> {
        let Some(optics) = &file.optics else {
            return match &file.mimda {
                Some(mimda) => {
                    Err(self.wrong(mimda.span(), "it needs optics.importance; add an [optics] table"))
                }
                None => Ok(None),
            };
        };
        Ok(Some(Look::InDataUnits(DataLook {
            domain: optics.domain.as_ref().map(|domain| self.domain(domain)).transpose()?,
            extinction: self.curve(&optics.extinction, |v: [f64; 1]| v[0])?,
            extinction_unit: optics.extinction_unit,
            colour: self.curve(&optics.colour, DVec3::from_array)?,
            mimda: self.mimda(optics, file.mimda.as_ref())?,
        })))
    }

    fn domain(&self, domain: &Spanned<[f64; 2]>) -> Checked<(f64, f64)> {
        let [low, high] = *domain.get_ref();
        let rising = low.is_finite() && high.is_finite() && low < high;
        let message =
            || format!("[{low}, {high}] is not a rising interval of finite numbers; give [low, high]");
        rising.then_some((low, high)).ok_or_else(|| self.wrong(domain.span(), message()))
    }

    fn mimda(&self, optics: &OpticsTable, table: Option<&Spanned<MimdaTable>>) -> Checked<Option<Mimda>> {
        match (&optics.importance, table) {
            (None, None) => Ok(None),
            (None, Some(table)) => Err(self.wrong(table.span(), "it needs optics.importance; add that key")),
            (Some(points), None) => {
                Err(self.wrong(points.span(), "it does nothing without a [mimda] table; add one"))
            }
            (Some(points), Some(table)) => {
                let above = |p: &&Spanned<Vec<f64>>| p.get_ref().get(1).is_some_and(|v| *v > 1.0);
                if let Some(point) = points.get_ref().iter().find(above) {
                    return Err(
                        self.wrong(point.span(), "an importance is above 1; importances lie in [0, 1]")
                    );
                }
                Ok(Some(Mimda {
                    importance: self.curve(points, |v: [f64; 1]| v[0])?,
                    gamma: self.within(&table.get_ref().gamma, 0.0..=1.0)?,
                    form: table.get_ref().form.unwrap_or(MimdaForm::Consistent),
                }))
            }
        }
    }

    /// A curve over data values; each point has one number for the value and N for what it maps to.
    fn curve<V: CurveValue, const N: usize>(
        &self,
        points: &Points,
        make: fn([f64; N]) -> V,
    ) -> Checked<Curve<V>> {
        let mut pairs = Vec::with_capacity(points.get_ref().len());
        for point in points.get_ref() {
            let numbers = point.get_ref();
            let rest = numbers.get(1..).and_then(|rest| <[f64; N]>::try_from(rest).ok());
            let count = || format!("a point has {} numbers; give {}", numbers.len(), N + 1);
            pairs.push((numbers.first().copied(), rest.ok_or_else(|| self.wrong(point.span(), count()))?));
        }
        let pairs = pairs.into_iter().filter_map(|(value, rest)| Some((value?, make(rest)))).collect();
        Curve::new(pairs).map_err(|error| {
            let at = match error {
                CurveError::Empty => points.span(),
                CurveError::NotANumber { index } | CurveError::NotSorted { index } => {
                    points.get_ref()[index].span()
                }
            };
            self.wrong(at, error.to_string())
        })
    }

    fn light(&self, table: &LightTable) -> Checked<Light> {
        let default = Light::default();
        let share = |number: &Option<Number>, otherwise| {
            number.as_ref().map_or(Ok(otherwise), |n| self.within(n, 0.0..=f64::MAX))
        };
        let toward = table.toward.as_ref().map(|t| self.direction(t)).transpose()?;
        Ok(Light {
            toward_light_in_display: toward.unwrap_or(default.toward_light_in_display),
            ambient: share(&table.ambient, default.ambient)?,
            diffuse: share(&table.diffuse, default.diffuse)?,
            specular: share(&table.specular, default.specular)?,
            shininess: table
                .shininess
                .as_ref()
                .map_or(Ok(default.shininess), |n| self.within(n, 1.0..=f64::MAX))?,
            gradient_half: table
                .gradient_half
                .as_ref()
                .map_or(Ok(default.gradient_half), |n| self.above_zero(n))?,
            detail: default.detail,
        })
    }

    fn quality(&self, table: &QualityTable) -> Checked<Quality> {
        let preset = table.preset.map_or(Quality::default(), |preset| preset.quality());
        let or = |number: &Option<Number>, otherwise, range: RangeInclusive<f64>| {
            number.as_ref().map_or(Ok(otherwise), |n| self.within(n, range))
        };
        Ok(Quality {
            step_voxels: table.step_voxels.as_ref().map_or(Ok(preset.step_voxels), |n| self.above_zero(n))?,
            tolerance: table.tolerance.as_ref().map_or(Ok(preset.tolerance), |n| self.above_zero(n))?,
            termination: or(&table.termination, preset.termination, 0.0..=1.0)?,
            lod_scale: or(&table.lod_scale, preset.lod_scale, 0.0..=f64::MAX)?,
            quadrilinear: preset.quadrilinear,
        })
    }

    fn observer(&self, table: &DisplayTable) -> Checked<Option<DVec3>> {
        table.observer_m.as_ref().map(|observer| self.before_screen(observer)).transpose()
    }

    fn tool(&self, table: &ToolTable) -> Checked<Tool> {
        let rest = super::tool_at_rest(table.kind);
        let tip = self.optional_point(&table.tip_m)?;
        let axis = table.axis.as_ref().map(|axis| self.direction(axis)).transpose()?;
        Ok(Tool {
            tip_in_display: tip.unwrap_or(rest.tip_in_display),
            axis_in_display: axis.unwrap_or(rest.axis_in_display),
            ..rest
        })
    }

    fn motion(&self, keyframes: &[KeyframeTable], has_tool: bool) -> Checked<Motion> {
        let mut motion = Motion::default();
        let mut last = f64::NEG_INFINITY;
        for key in keyframes {
            let time_s = self.finite(&key.time_s)?;
            if time_s <= last {
                return Err(self.wrong(
                    key.time_s.span(),
                    "it is not after the keyframe ahead of it; sort keyframes by time",
                ));
            }
            last = time_s;
            self.add_keyframe(&mut motion, key, time_s, has_tool)?;
        }
        Ok(motion)
    }

    fn add_keyframe(
        &self,
        motion: &mut Motion,
        key: &KeyframeTable,
        time_s: f64,
        has_tool: bool,
    ) -> Checked<()> {
        if let (Some(moved), false) = (key.tool_tip_m.as_ref().or(key.tool_axis.as_ref()), has_tool) {
            return Err(self.wrong(moved.span(), "the scene has no tool; add a [tool] table"));
        }
        if let Some(observer) = &key.observer_m {
            motion.observer_m.push(time_s, self.before_screen(observer)?);
        }
        if let Some(centre) = &key.centre_m {
            motion.centre_m.push(time_s, self.point(centre)?);
        }
        if let Some(deg) = &key.rotation_deg {
            motion.rotation.push(time_s, rotation_from_deg(self.point(deg)?));
        }
        if let Some(tip) = &key.tool_tip_m {
            motion.tool_tip_m.push(time_s, self.point(tip)?);
        }
        if let Some(axis) = &key.tool_axis {
            motion.tool_axis.push(time_s, Direction(self.direction(axis)?));
        }
        Ok(())
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
