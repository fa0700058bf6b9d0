//! The arguments of `lightloom simulate`.

use super::parse::point;
use crate::scene::QualityPreset;
use backend::protocol::{DeviceChoice, FilterChoice};
use clap::{Args, ValueEnum};
use glam::DVec3;
use std::path::PathBuf;

/// `lightloom simulate`.
#[derive(Clone, Debug, Args)]
pub struct SimulateArgs {
    /// A .toml scene, a .lloom store, procedural:NAME or procedural:NAME@VOXELS with shells, marschner-lobb or sparse-vessels.
    pub scene: String,
    /// A display: a preset's name (see `lightloom displays`) or a .toml file.
    #[arg(long, value_name = "DISPLAY", default_value = "holo72")]
    pub display: String,
    /// Folder for pictures and report; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// How many back-ends share the projectors; 1 unless a launcher started more.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub backends: Option<u32>,
    /// Which device casts the rays.
    #[arg(long, value_enum, default_value = "auto")]
    pub device: DeviceArg,
    /// How voxels are interpolated.
    #[arg(long, value_enum, default_value = "auto")]
    pub filter: FilterArg,
    /// An eye whose view is synthesised, metres from the screen's centre: x right, y up, z toward the viewers. Repeat it for more.
    #[arg(long = "eye", value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub eyes: Vec<DVec3>,
    /// Write linear OpenEXR pictures too.
    #[arg(long)]
    pub exr: bool,
    /// Brick cache of each back-end.
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u64).range(1..=1 << 30))]
    pub cache_mib: u64,
    /// Quality in place of the scene's.
    #[arg(long, value_enum)]
    pub quality: Option<QualityPreset>,
    /// Frames A to B − 1 of the scene instead of all.
    #[arg(long, value_name = "A..B", value_parser = frame_range)]
    pub frames: Option<(u32, u32)>,
    /// No progress, no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Print the report as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

/// See [`DeviceChoice`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeviceArg {
    /// The GPU, or the CPU where there is no Vulkan driver.
    Auto,
    /// The GPU or nothing.
    Gpu,
    /// All cores of the CPU.
    Cpu,
}

impl From<DeviceArg> for DeviceChoice {
    fn from(device: DeviceArg) -> Self {
        match device {
            DeviceArg::Auto => DeviceChoice::Auto,
            DeviceArg::Gpu => DeviceChoice::Gpu,
            DeviceArg::Cpu => DeviceChoice::Cpu,
        }
    }
}

/// See [`FilterChoice`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FilterArg {
    /// The texture unit where it is precise, exact otherwise.
    Auto,
    /// The texture unit, whatever its precision.
    Hardware,
    /// Eight fetches, interpolated in f32.
    Exact,
}

impl From<FilterArg> for FilterChoice {
    fn from(filter: FilterArg) -> Self {
        match filter {
            FilterArg::Auto => FilterChoice::Auto,
            FilterArg::Hardware => FilterChoice::Hardware,
            FilterArg::Exact => FilterChoice::Exact,
        }
    }
}

fn frame_range(text: &str) -> Result<(u32, u32), String> {
    let range =
        text.split_once("..").and_then(|(a, b)| Some((a.trim().parse().ok()?, b.trim().parse().ok()?)));
    range
        .filter(|(a, b)| a < b)
        .ok_or_else(|| "give a rising range such as 0..10, its end not included".to_owned())
}
