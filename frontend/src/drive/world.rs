//! What has happened to a scene since it was loaded. Pure: the same changes at the same times give the same frames.

use super::Change;
use super::grip::Grip;
use crate::scene::{
    Anchor, CLIP_CONTEXT, Handling, HeldTool, LookName, Scene, SceneEnhancer, SceneError, Values, VolumeFacts,
};
use display_config::Display;
use glam::{DQuat, DVec3};
use optics::{ClipPlane, Enhancer, MOST_ENHANCERS};
use protocol::{FrameState, Pace, SubFrame, VolumeRef};
use std::time::Duration;

/// Sizes that a volume may have, as factors of the scene's.
const SCALES: (f64, f64) = (0.05, 50.0);
/// How far its centre may be from where the scene has it, in widths of the screen.
const FARTHEST: f64 = 5.0;

/// Times that differ by less are the same, seconds: steps of a rate add up to a little less or more.
const LEAST_STEP_S: f64 = 1e-6;

/// The looks that a world can go through.
#[derive(Clone, Debug, Default)]
pub struct Looks {
    /// What the volume's values tell; None where the scene's own look stays.
    pub values: Option<Values>,
    /// Those that fit.
    pub names: Vec<LookName>,
    /// The one that is shown, if it is one of these.
    pub shown: Option<LookName>,
}

/// A scene and what has become of it.
#[derive(Clone, Debug)]
pub struct World {
    /// As it was loaded.
    loaded: Scene,
    scene: Scene,
    facts: VolumeFacts,
    display: Display,
    looks: Looks,
    handling: Handling,
    /// Where the clip plane is: metres before the volume's centre; None where there is none.
    clip_m: Option<f64>,
    /// While a hand holds the volume.
    grip: Option<Grip>,
    is_paused: bool,
    /// Time of the script, seconds.
    script_s: f64,
    /// When the frame before is seen.
    seen_at: Option<Duration>,
    pace: Pace,
    has_sub_frames: bool,
}

impl World {
    /// A world in which nothing has happened yet. Its frames get their detail at this pace.
    pub fn new(scene: Scene, facts: VolumeFacts, display: Display, pace: Pace, looks: Looks) -> Self {
        Self {
            loaded: scene.clone(),
            scene,
            facts,
            display,
            looks,
            handling: Handling::default(),
            clip_m: None,
            grip: None,
            is_paused: false,
            script_s: 0.0,
            seen_at: None,
            pace,
            has_sub_frames: true,
        }
    }

    /// Its frames cast all pixels, or a quarter of them.
    #[must_use]
    pub fn with_sub_frames(self, has_sub_frames: bool) -> Self {
        Self { has_sub_frames, ..self }
    }

    /// The display that it is shown on.
    pub fn display(&self) -> &Display {
        &self.display
    }

    /// What people call its scene.
    pub fn name(&self) -> &str {
        &self.scene.name
    }

    /// Its volume.
    pub fn volume_ref(&self) -> VolumeRef {
        self.scene.volume_ref()
    }

    /// The look that is shown, where it is one of the library.
    pub fn look(&self) -> Option<LookName> {
        self.looks.shown
    }

    /// Something happens.
    pub fn apply(&mut self, change: Change) {
        match change {
            Change::Turn { right, down } => {
                let turn = DQuat::from_rotation_y(right) * DQuat::from_rotation_x(down) * self.handling.turn;
                self.handling.turn = turn.normalize();
            }
            Change::Move(by_m) => self.shift_to(self.handling.shift_m + by_m),
            Change::Scale(factor) => {
                self.handling.scale = (self.handling.scale * factor).clamp(SCALES.0, SCALES.1);
            }
            Change::Clip => self.clip_m = if self.clip_m.is_some() { None } else { Some(0.0) },
            Change::MoveClip(by_m) => {
                let farthest = FARTHEST * self.display.width_m;
                self.clip_m = self.clip_m.map(|at_m| (at_m + by_m).clamp(-farthest, farthest));
            }
            Change::Tool(tool) => self.hold(tool),
            Change::Grip(closes) => self.grip = if closes { self.taken_hold() } else { None },
            Change::NextLook => self.next_look(),
            Change::Pause => self.is_paused = !self.is_paused,
            Change::Reset => self.reset(),
            Change::Help | Change::Quit => {}
        }
    }

    fn shift_to(&mut self, shift_m: DVec3) {
        self.handling.shift_m = shift_m.clamp_length_max(FARTHEST * self.display.width_m);
    }

    /// The tool is here, and takes along what it holds. One that is lost lets go.
    fn hold(&mut self, tool: HeldTool) {
        self.handling.tool = Some(tool);
        self.grip = self.grip.filter(|_| tool.presence > 0.0);
        if let Some(grip) = self.grip {
            let (centre_m, turn) = grip.moved(&tool);
            self.handling.turn = turn;
            self.shift_to(centre_m - self.scene.centre_at(self.script_s));
        }
    }

    /// The grip of the tool on the volume as it is now, if there is a tool.
    fn taken_hold(&self) -> Option<Grip> {
        let tool = self.handling.tool.filter(|tool| tool.presence > 0.0)?;
        let centre_m = self.scene.centre_at(self.script_s) + self.handling.shift_m;
        Some(Grip::new(tool, centre_m, self.handling.turn))
    }

    fn reset(&mut self) {
        // Whoever holds a tool goes on holding it.
        let tool = self.handling.tool;
        (self.handling, self.grip) = (Handling { tool, ..Handling::default() }, None);
        (self.clip_m, self.is_paused) = (None, false);
        self.scene = self.loaded.clone();
        self.looks.shown = None;
    }

    fn next_look(&mut self) {
        let Looks { values: Some(values), names, shown } = &self.looks else { return };
        let place = shown.and_then(|shown| names.iter().position(|&name| name == shown));
        let Some(&name) = names.get(place.map_or(0, |place| (place + 1) % names.len())) else { return };
        self.scene.take_look(name, values, &self.facts);
        self.looks.shown = Some(name);
    }

    /// Whether a script has come to its end. A scene in which nothing moves has none.
    pub fn is_over(&self) -> bool {
        let last = self.scene.frame_count.saturating_sub(1);
        last > 0 && self.script_s + LEAST_STEP_S >= f64::from(last) / self.scene.rate_hz
    }

    /// The frame that is seen at a time of the display's clock: not before the frame that was made before it.
    ///
    /// # Errors
    /// The look does not fit the volume.
    pub fn frame(&mut self, index: u32, seen_at: Duration) -> Result<FrameState, SceneError> {
        let passed = self.seen_at.map_or(Duration::ZERO, |before| seen_at.saturating_sub(before));
        self.seen_at = Some(seen_at);
        if !self.is_paused {
            self.script_s += passed.as_secs_f64();
        }
        let scene = self.clipped();
        let scene = scene.as_ref().unwrap_or(&self.scene);
        let frame = scene.frame_at(index, self.script_s, &self.handling, &self.display, &self.facts)?;
        Ok(FrameState {
            // The working set's clock goes on while the script stands still.
            time_s: seen_at.as_secs_f64(),
            pace: self.pace,
            sub_frame: self.has_sub_frames.then(|| SubFrame::of_frame(index)),
            ..frame
        })
    }

    /// The scene with the clip plane, where there is one, and room for it in the chain.
    fn clipped(&self) -> Option<Scene> {
        let at_m = self.clip_m.filter(|_| self.scene.enhancers.len() < MOST_ENHANCERS)?;
        let centre_m = self.scene.centre_at(self.script_s) + self.handling.shift_m;
        let point_in_display = centre_m + DVec3::Z * at_m;
        let plane = ClipPlane {
            point_in_display,
            normal_in_display: DVec3::Z,
            context: CLIP_CONTEXT,
            thickness_m: 0.0,
            boost: 1.0,
            strength: 1.0,
        };
        let mut scene = self.scene.clone();
        let anchor = Anchor::Point(point_in_display);
        scene.enhancers.insert(0, SceneEnhancer { numbers: Enhancer::ClipPlane(plane), anchor });
        Some(scene)
    }
}

#[cfg(test)]
#[path = "world_tests.rs"]
mod tests;
