//! The arguments of `lightloom gallery`.

use super::BackendArgs;
use super::parse::picture_size;
use crate::scene::{LookName, QualityPreset};
use clap::Args;
use glam::UVec2;
use std::path::PathBuf;

/// `lightloom gallery`.
#[derive(Clone, Debug, Args)]
pub struct GalleryArgs {
    /// A .toml scene, a .lloom store, procedural:NAME or procedural:NAME@VOXELS; its first frame is shown.
    pub scene: String,
    /// Folder for the page and its pictures; created if missing.
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
    /// A display: a preset's name (see `lightloom displays`) or a .toml file.
    #[arg(long, value_name = "DISPLAY", default_value = "desk8")]
    pub display: String,
    /// Pixels of each projector, and so of each picture, overriding the display's.
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = picture_size, allow_hyphen_values = true)]
    pub size: Option<UVec2>,
    /// A look of the library; a scene's own [optics] win over it. Without it, the volume's values choose one.
    #[arg(long, value_name = "NAME", value_enum)]
    pub look: Option<LookName>,
    /// Quality, overriding the scene's.
    #[arg(long, value_enum)]
    pub quality: Option<QualityPreset>,
    /// What draws the pictures.
    #[command(flatten)]
    pub drawing: BackendArgs,
    /// No progress, no summary.
    #[arg(long)]
    pub quiet: bool,
}
