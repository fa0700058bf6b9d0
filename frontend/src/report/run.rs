//! The account of a whole run.

use super::legend::{LEGEND, shows};
use super::{BackendSummary, FrameSummary, LiveSummary, Totals, peak_memory_bytes};
use crate::scene::{PROCEDURAL_PREFIX, Scene, VolumeFacts, VolumeSource};
use display_config::Display;
use optics::DebugView;
use protocol::FrameState;
use serde::Serialize;
use std::time::Duration;

/// A whole run.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of the program.
    pub version: &'static str,
    /// How it was called.
    pub command_line: Vec<String>,
    /// The scene.
    pub scene: SceneSummary,
    /// The display.
    pub display: DisplaySummary,
    /// What each back-end drew, and with what.
    pub backends: Vec<BackendSummary>,
    /// What is shown in place of the pictures.
    pub debug_view: Option<DebugSummary>,
    /// The eyes.
    pub eyes: Vec<EyeSummary>,
    /// The frames.
    pub frames: Vec<FrameSummary>,
    /// How the live ones went, one after the other; None where none was live.
    pub live: Option<LiveSummary>,
    /// All frames added up.
    pub total: Totals,
    /// Peak memory of this process, bytes; None where the system does not tell.
    pub peak_memory_bytes: Option<u64>,
    /// Wall-clock milliseconds of the whole run.
    pub wall_ms: f64,
}

/// The scene, in brief.
#[derive(Clone, Debug, Serialize)]
pub struct SceneSummary {
    /// Its name.
    pub name: String,
    /// The volume: a path, or `procedural:NAME`.
    pub volume: String,
    /// What is known of the volume.
    pub facts: VolumeFacts,
    /// Its longest edge in the display in the first frame, metres.
    pub longest_m: f64,
    /// See [`optics::Quality`].
    pub quality: optics::Quality,
}

/// The display, in brief.
#[derive(Clone, Debug, Serialize)]
pub struct DisplaySummary {
    /// Its name.
    pub name: String,
    /// Width of the screen, metres.
    pub width_m: f64,
    /// Height of the screen, metres.
    pub height_m: f64,
    /// How many projectors.
    pub projectors: usize,
    /// Pixels of all projectors.
    pub pixels: u64,
    /// s0, metres.
    pub pixel_size_m: f64,
    /// Φ, degrees.
    pub angular_accuracy_deg: f64,
    /// η in effect.
    pub eta: f64,
    /// The virtual observer of the first frame, metres.
    pub observer_m: [f64; 3],
}

/// A debug view, in brief.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct DebugSummary {
    /// Which one.
    pub view: DebugView,
    /// What its colours tell.
    pub shows: &'static str,
    /// The values at the ends of its scale.
    pub scale: (f64, f64),
    /// The file of its key, from the output folder.
    pub legend: &'static str,
}

/// An eye, in brief.
#[derive(Clone, Debug, Serialize)]
pub struct EyeSummary {
    /// Where it is, metres.
    pub position_m: [f64; 3],
    /// How many projectors it sees at all.
    pub projectors_seen: usize,
    /// Where it is outside the viewing zone: a sentence that says so.
    pub warning: Option<String>,
}

/// What a run was about.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What is known of its volume.
    pub facts: &'a VolumeFacts,
    /// The display.
    pub display: &'a Display,
    /// The first frame.
    pub first_frame: &'a FrameState,
}

impl Report {
    /// The report of a run that is done.
    pub fn new(
        subject: &Subject<'_>,
        eyes: Vec<EyeSummary>,
        backends: Vec<BackendSummary>,
        frames: Vec<FrameSummary>,
        wall: Duration,
    ) -> Self {
        let total = Totals::of(frames.iter().flat_map(|frame| &frame.backends));
        let display = DisplaySummary::new(subject.display, subject.first_frame);
        Self {
            version: env!("CARGO_PKG_VERSION"),
            command_line: command_line(),
            scene: SceneSummary::new(subject.scene, subject.facts, subject.first_frame),
            live: LiveSummary::of(&frames, display.pixels),
            display,
            backends,
            debug_view: subject.first_frame.debug.map(DebugSummary::new),
            eyes,
            frames,
            total,
            peak_memory_bytes: peak_memory_bytes(),
            wall_ms: 1e3 * wall.as_secs_f64(),
        }
    }

    /// A sentence for each eye outside the viewing zone, led by which one it is.
    pub fn eye_warnings(&self) -> impl Iterator<Item = String> {
        let warnings = self.eyes.iter().enumerate();
        warnings.filter_map(|(index, eye)| Some(format!("eye {index}: {}", eye.warning.as_ref()?)))
    }
}

impl DebugSummary {
    fn new(view: DebugView) -> Self {
        Self { view, shows: shows(view), scale: view.scale(), legend: LEGEND }
    }
}

impl SceneSummary {
    pub(super) fn new(scene: &Scene, facts: &VolumeFacts, frame: &FrameState) -> Self {
        let volume = match &scene.volume {
            VolumeSource::Store(path) => path.display().to_string(),
            VolumeSource::Procedural { name, .. } => format!("{PROCEDURAL_PREFIX}{name}"),
        };
        let linear = frame.display_from_volume.matrix3;
        let dims = facts.dims.as_dvec3().to_array();
        let edges_m = [0, 1, 2].map(|axis| linear.col(axis).length() * dims[axis]);
        let longest_m = edges_m.into_iter().fold(0.0, f64::max);
        Self { name: scene.name.clone(), volume, facts: *facts, longest_m, quality: scene.quality }
    }
}

impl DisplaySummary {
    pub(super) fn new(display: &Display, frame: &FrameState) -> Self {
        let pixels = |p: &display_config::Projector| u64::from(p.raster.width) * u64::from(p.raster.height);
        Self {
            name: display.name.clone(),
            width_m: display.width_m,
            height_m: display.height_m,
            projectors: display.projectors.len(),
            pixels: display.projectors.iter().map(pixels).sum(),
            pixel_size_m: display.pixel_size_m,
            angular_accuracy_deg: display.angular_accuracy.to_degrees(),
            eta: frame.eta,
            observer_m: frame.observer_in_display.to_array(),
        }
    }
}

/// How this program was called.
pub(super) fn command_line() -> Vec<String> {
    std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect()
}
