//! What a scene holds, and its frames.

use super::band::normalised_band;
use super::volume::PROCEDURAL_VOXEL_M;
use super::{
    Band, Edits, Handled, HeldTool, Look, LookWish, Motion, Placement, SceneEnhancer, SceneError, Tool,
    ToolKind, VolumeFacts, VolumeSource,
};
use display_config::{Display, Place};
use glam::DVec3;
use optics::{Enhancer, Light, Optics, Quality, Trapezoid, TrapezoidError};
use protocol::{FrameState, Pace, VolumeRef};
use std::ops::Range;

/// A scene, read and checked. Everything that is the same in all frames is here; `motion`
/// and `edits` hold the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// What people call it: the argument or the file's stem.
    pub name: String,
    /// Which volume.
    pub volume: VolumeSource,
    /// What names the volume; None where that is the command line.
    pub source_place: Option<Place>,
    /// Edge lengths of a voxel, metres, in place of what the volume says of itself; its axes' directions stay.
    pub voxel_size_m: Option<DVec3>,
    /// Where the volume floats.
    pub placement: Placement,
    /// What scalars look like.
    pub look: Look,
    /// Where the look is to come from: see [`Scene::fit_look`].
    pub wish: LookWish,
    /// Bands of data values that have a name.
    pub bands: Vec<Band>,
    /// The chain of enhancers, in order.
    pub enhancers: Vec<SceneEnhancer>,
    /// Gradient shading; None shows the plain colours.
    pub light: Option<Light>,
    /// How closely the continuous model is followed.
    pub quality: Quality,
    /// η in place of the display's.
    pub eta: Option<f64>,
    /// The virtual observer in place of the display's, metres.
    pub observer_m: Option<DVec3>,
    /// The tool at rest, where there is one.
    pub tool: Option<Tool>,
    /// What moves.
    pub motion: Motion,
    /// What keyframes change of the look.
    pub edits: Edits,
    /// How many frames, from 0.
    pub frame_count: u32,
    /// Frames per second of the scene's clock.
    pub rate_hz: f64,
}

impl Scene {
    /// The volume as a back-end finds it.
    pub fn volume_ref(&self) -> VolumeRef {
        match &self.volume {
            VolumeSource::Store(path) => VolumeRef::Store(path.clone()),
            VolumeSource::Procedural { name, dims } => VolumeRef::Procedural {
                name: name.clone(),
                dims: *dims,
                voxel_size_m: self.voxel_size_m.unwrap_or(PROCEDURAL_VOXEL_M),
            },
        }
    }

    /// Frame `index` at `index / rate_hz` seconds. Fails only where the look does not fit the volume's values.
    pub fn frame(
        &self,
        index: u32,
        display: &Display,
        facts: &VolumeFacts,
    ) -> Result<FrameState, SceneError> {
        let time_s = f64::from(index) / self.rate_hz;
        self.frame_at(index, time_s, &Handled::default(), display, facts)
    }

    /// A frame at a time of the scene's clock, seconds, with what people have made of it. Fails only where the look
    /// does not fit the volume's values.
    pub fn frame_at(
        &self,
        index: u32,
        time_s: f64,
        handled: &Handled,
        display: &Display,
        facts: &VolumeFacts,
    ) -> Result<FrameState, SceneError> {
        let spacing_m = self.voxel_size_m.unwrap_or(facts.voxel_size_m());
        let extent_m = facts.dims.as_dvec3() * spacing_m;
        let scale = self.placement.scale(extent_m, display) * handled.handling.scale;
        let place = handled.applied(self.placement_at(time_s));
        let observer = self.observer_m.unwrap_or(display.observer_in_display);
        Ok(FrameState {
            index,
            time_s,
            observer_in_display: self.motion.observer_m.at(time_s).unwrap_or(observer),
            eta: self.eta.unwrap_or(display.eta),
            display_from_volume: place.display_from_volume(facts.dims, spacing_m * scale, &facts.frame),
            optics: self.optics_at(
                time_s,
                handled,
                place.centre_m,
                facts.value_range,
                extent_m.max_element() * scale,
            )?,
            light: handled.lit(self.tool_light(time_s, handled.tool)),
            quality: self.quality,
            volume: None,
            pace: Pace::Complete,
            sub_frame: None,
            refinement: None,
            welcomes_planes: false,
            debug: None,
            marks: Vec::new(),
        })
    }

    /// Whether the look fits the volume in some frames: it changes at keyframes only, so that not every frame is made.
    pub fn check_frames(
        &self,
        frames: Range<u32>,
        display: &Display,
        facts: &VolumeFacts,
    ) -> Result<(), SceneError> {
        self.frame(frames.start, display, facts)?;
        let last_s = f64::from(frames.end.saturating_sub(1)) / self.rate_hz;
        let longest_m =
            (facts.dims.as_dvec3() * self.voxel_size_m.unwrap_or(facts.voxel_size_m())).max_element();
        for time_s in self.edits.times().filter(|&time_s| time_s <= last_s) {
            self.optics_at(
                time_s,
                &Handled::default(),
                self.centre_at(time_s),
                facts.value_range,
                longest_m,
            )?;
        }
        Ok(())
    }

    /// The look at a time for a volume of those values at that place, whose longest edge is `longest_m` metres in the display.
    fn optics_at(
        &self,
        time_s: f64,
        handled: &Handled,
        centre_m: DVec3,
        value_range: (f64, f64),
        longest_m: f64,
    ) -> Result<Optics, SceneError> {
        let look = self.look.edited(&self.edits, time_s);
        let own = self.chain_around(centre_m, time_s, handled);
        let chain: Vec<Enhancer> = handled.carried.iter().copied().chain(own).collect();
        let optics = look.optics(value_range, longest_m, handled.window, &chain);
        optics.map_err(|reason| self.look_error(value_range, reason))
    }

    pub(super) fn look_error(&self, (low, high): (f64, f64), reason: String) -> SceneError {
        SceneError::Look { scene: self.name.clone(), low, high, reason }
    }

    fn placement_at(&self, time_s: f64) -> Placement {
        let still = self.placement;
        let centre_m = self.motion.centre_m.at(time_s).unwrap_or(still.centre_m);
        let rotation = self.motion.rotation.at(time_s).unwrap_or(still.rotation);
        Placement { centre_m, rotation, ..still }
    }

    /// Where the volume's centre is at a time, metres, display frame.
    pub fn centre_at(&self, time_s: f64) -> DVec3 {
        self.placement_at(time_s).centre_m
    }

    /// The bands over s of a domain, in the order of the file.
    pub fn bands_over(&self, domain: (f64, f64)) -> Result<Vec<Trapezoid>, SceneError> {
        let failed = |e: TrapezoidError| self.look_error(domain, e.to_string());
        self.bands.iter().map(|band| normalised_band(band.values, domain).map_err(failed)).collect()
    }

    /// The enhancers in their places, bands over data values.
    pub(super) fn chain_at(&self, time_s: f64) -> Vec<Enhancer> {
        self.chain_around(self.centre_at(time_s), time_s, &Handled::default())
    }

    /// The enhancers in their places around the volume's centre, bands over data values.
    fn chain_around(&self, centre_m: DVec3, time_s: f64, handled: &Handled) -> Vec<Enhancer> {
        let tool = self.tool_at(time_s, handled.tool);
        let picked = handled.picked.or(self.edits.pick.at(time_s).copied());
        let presence = handled.tool.map_or(1.0, |held| held.presence);
        let placed = |enhancer: &SceneEnhancer| enhancer.placed(centre_m, tool.as_ref(), presence, picked);
        self.enhancers.iter().map(placed).collect()
    }

    /// The light after the scene's own tool has had its say.
    fn tool_light(&self, time_s: f64, held: Option<HeldTool>) -> Option<Light> {
        let light = self.light?;
        match self.tool_at(time_s, held) {
            Some(Tool { kind: ToolKind::Light, axis_in_display, .. }) => {
                Some(Light { toward_light_in_display: -axis_in_display, ..light })
            }
            Some(Tool { kind: ToolKind::Pointer, .. }) | None => Some(light),
        }
    }

    fn tool_at(&self, time_s: f64, held: Option<HeldTool>) -> Option<Tool> {
        let still = self.tool?;
        if let Some(held) = held {
            return Some(Tool { tip_in_display: held.tip_m, axis_in_display: held.axis(), ..still });
        }
        let tip_in_display = self.motion.tool_tip_m.at(time_s).unwrap_or(still.tip_in_display);
        let axis = self.motion.tool_axis.at(time_s).map(|d| d.0);
        Some(Tool { tip_in_display, axis_in_display: axis.unwrap_or(still.axis_in_display), ..still })
    }
}
