//! The arguments of `lightloom looks`.

use super::BackendArgs;
use super::parse::picture_size;
use crate::scene::QualityPreset;
use clap::Args;
use glam::UVec2;
use std::path::PathBuf;

/// `lightloom looks`.
#[derive(Clone, Debug, Args)]
pub struct LooksArgs {
    /// A .lloom store, a .toml scene, procedural:NAME or procedural:NAME@VOXELS; its first frame is shown.
    #[arg(value_name = "VOLUME")]
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
