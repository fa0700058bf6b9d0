//! The arguments of `lightloom simulate`.

use super::parse::point;
use super::{BackendArgs, DebugViewArg, LiveArgs};
use crate::scene::{LookName, QualityPreset};
use clap::Args;
use glam::DVec3;
use std::path::PathBuf;

/// `lightloom simulate`.
#[derive(Clone, Debug, Args)]
pub struct SimulateArgs {
    /// A .toml scene, a .lloom store, procedural:NAME or procedural:NAME@VOXELS with shells, marschner-lobb or sparse-vessels.
    pub scene: String,
    /// A display: a preset's name (see `lightloom displays`) or a .toml file. [default: holo72; that of an exhibit]
    #[arg(long, value_name = "DISPLAY")]
    pub display: Option<String>,
    /// Folder for pictures and report; created if missing.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// What draws the pictures.
    #[command(flatten)]
    pub drawing: BackendArgs,
    /// An eye whose view is synthesised, metres from the screen's centre: x right, y up, z toward the viewers. Repeat it for more.
    #[arg(long = "eye", value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub eyes: Vec<DVec3>,
    /// Write linear OpenEXR pictures too.
    #[arg(long)]
    pub exr: bool,
    /// Write what every projector is sent, too: its picture with the display's mesh, blend, black level and transfer curve.
    #[arg(long)]
    pub calibrated: bool,
    /// A look of the library; a scene's own [optics] win over it, and an exhibit has looks of its own. Without it, the volume's values choose one.
    #[arg(long, value_name = "NAME", value_enum)]
    pub look: Option<LookName>,
    /// Quality, overriding the scene's or exhibit's.
    #[arg(long, value_enum)]
    pub quality: Option<QualityPreset>,
    /// What was made of the scene, or of an exhibit in its place, when this tape was recorded. Without --frames, its last frame.
    #[arg(long, value_name = "TAPE.mcap")]
    pub tape: Option<PathBuf>,
    /// Frames A to B − 1 of the scene instead of all.
    #[arg(long, value_name = "A..B", value_parser = frame_range, allow_hyphen_values = true)]
    pub frames: Option<(u32, u32)>,
    /// Write the scene that is drawn as a scene file, with its look, to change and to draw again.
    #[arg(long, value_name = "SCENE.toml")]
    pub save_scene: Option<PathBuf>,
    /// How frames get their detail.
    #[command(flatten)]
    pub live: LiveArgs,
    /// Show the working set instead of the pictures, with a legend of its colours.
    #[arg(long, value_name = "NAME", value_enum)]
    pub debug_view: Option<DebugViewArg>,
    /// No progress, no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Print the report as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

fn frame_range(text: &str) -> Result<(u32, u32), String> {
    let range =
        text.split_once("..").and_then(|(a, b)| Some((a.trim().parse().ok()?, b.trim().parse().ok()?)));
    range
        .filter(|(a, b)| a < b)
        .ok_or_else(|| "give a rising range such as 0..10, its end not included".to_owned())
}
