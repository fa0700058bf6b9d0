//! What a run reports of itself, as JSON for programs and as a page for people.

pub mod accuracy;
mod frame;
pub(crate) mod html;
mod memory;
pub(crate) mod page;
pub mod plot;
mod stage_bar;
pub mod units;
mod upkeep;

pub use frame::{FrameSummary, Totals};
pub use memory::peak_memory_bytes;

use crate::FrontendError;
use crate::scene::{Scene, VolumeFacts, VolumeSource};
use crate::simulate::{Job, LEGEND, shows};
use display_config::Display;
use optics::DebugView;
use protocol::{DeviceInfo, FrameState};
use renderer::output::{OutputError, write_atomically};
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

/// The report for programs, in the output folder.
pub const JSON: &str = "report.json";
/// The report for people, in the output folder.
pub const HTML: &str = "report.html";

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
    /// What each back-end drew with.
    pub backends: Vec<DeviceInfo>,
    /// What is shown instead of the pictures.
    pub debug_view: Option<DebugSummary>,
    /// The eyes.
    pub eyes: Vec<EyeSummary>,
    /// The frames.
    pub frames: Vec<FrameSummary>,
    /// The sum of all frames.
    pub total: Totals,
    /// Peak memory of this process, bytes; None if the system does not say.
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
    /// What its colours show.
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
    /// A sentence that says so if it is outside the viewing zone.
    pub warning: Option<String>,
}

impl Report {
    /// The report of a run that is done.
    pub fn new(
        scene: &Scene,
        facts: &VolumeFacts,
        job: &Job,
        backends: Vec<DeviceInfo>,
        frames: Vec<FrameSummary>,
        wall: Duration,
    ) -> Self {
        let total = Totals::of(frames.iter().flat_map(|frame| &frame.backends));
        Self {
            version: env!("CARGO_PKG_VERSION"),
            command_line: command_line(),
            scene: SceneSummary::new(scene, facts, job.frames.first()),
            display: DisplaySummary::new(&job.display, job.frames.first()),
            backends,
            debug_view: job.debug_view().map(DebugSummary::new),
            eyes: job.eye_summaries(),
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
    fn new(scene: &Scene, facts: &VolumeFacts, frame: Option<&FrameState>) -> Self {
        let volume = match &scene.volume {
            VolumeSource::Store(path) => path.display().to_string(),
            VolumeSource::Procedural { name, .. } => format!("procedural:{name}"),
        };
        let edges_m = frame.map_or([0.0; 3], |frame| {
            let linear = frame.display_from_volume.matrix3;
            let dims = facts.dims.as_dvec3().to_array();
            [0, 1, 2].map(|axis| linear.col(axis).length() * dims[axis])
        });
        let longest_m = edges_m.into_iter().fold(0.0, f64::max);
        Self { name: scene.name.clone(), volume, facts: *facts, longest_m, quality: scene.quality }
    }
}

impl DisplaySummary {
    fn new(display: &Display, frame: Option<&FrameState>) -> Self {
        let pixels = |p: &display_config::Projector| u64::from(p.raster.width) * u64::from(p.raster.height);
        let (eta, observer) = frame.map_or((display.eta, display.observer_in_display), |frame| {
            (frame.eta, frame.observer_in_display)
        });
        Self {
            name: display.name.clone(),
            width_m: display.width_m,
            height_m: display.height_m,
            projectors: display.projectors.len(),
            pixels: display.projectors.iter().map(pixels).sum(),
            pixel_size_m: display.pixel_size_m,
            angular_accuracy_deg: display.angular_accuracy.to_degrees(),
            eta,
            observer_m: observer.to_array(),
        }
    }
}

/// How this program was called.
fn command_line() -> Vec<String> {
    std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect()
}

/// Writes both reports; the page holds the pictures that it shows.
pub fn write(report: &Report, out: &Path) -> Result<(), FrontendError> {
    write_text(&out.join(JSON), &serde_json::to_string_pretty(report)?)?;
    write_text(&out.join(HTML), &page::page(report, out)?)?;
    Ok(())
}

pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), OutputError> {
    let failed = |source| OutputError::Write { path: path.to_owned(), source };
    write_atomically(path, |file| file.write_all(text.as_bytes()).map_err(failed))
}
