//! The command line.

mod export;

pub use export::ExportArgs;

use crate::scene::QualityPreset;
use backend::protocol::{DeviceChoice, FilterChoice};
use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::{DVec3, UVec3};
use std::path::PathBuf;

/// Volume rendering for projector-based light-field displays.
#[derive(Clone, Debug, Parser)]
#[command(name = "lightloom", version)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What the program can do.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Render what every projector of a display shows, and what eyes before it see.
    Simulate(SimulateArgs),
    /// Turn a volume file into a store of bricks.
    Import(ImportArgs),
    /// Write a level of a store, or a part of it, as NRRD or OME-Zarr.
    Export(ExportArgs),
    /// List the displays that come with the program.
    Displays,
}

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

/// `lightloom import`.
#[derive(Clone, Debug, Args)]
pub struct ImportArgs {
    /// A NIfTI, NRRD, MetaImage or raw file, procedural:NAME or procedural:NAME@VOXELS.
    pub input: PathBuf,
    /// The store to write.
    #[arg(short, long, value_name = "OUT.lloom")]
    pub output: PathBuf,
    /// Bits per voxel in the store.
    #[arg(long, value_enum, default_value = "8")]
    pub bits: BitsArg,
    /// How bricks are compressed.
    #[arg(long, value_enum, default_value = "lz4")]
    pub codec: CodecArg,
    /// The voxels of a file without header.
    #[command(flatten)]
    pub raw: RawArgs,
    /// No progress, no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Print what was done as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

/// What a file without header holds.
#[derive(Clone, Debug, Args)]
pub struct RawArgs {
    /// Voxels along x (fastest), y and z: the input is then read as raw voxels.
    #[arg(long = "raw-dims", value_name = "X,Y,Z", value_parser = dims, requires = "element")]
    pub dims: Option<UVec3>,
    /// Type of a voxel: uint8, int16, float, …
    #[arg(long = "raw-type", value_name = "TYPE", requires = "dims")]
    pub element: Option<String>,
    /// Byte order of a voxel.
    #[arg(long = "raw-endian", value_enum, default_value = "little", requires = "dims")]
    pub endian: EndianArg,
    /// Edge lengths of a voxel, millimetres.
    #[arg(long = "raw-spacing-mm", value_name = "X,Y,Z", value_parser = spacing, default_value = "1,1,1", requires = "dims")]
    pub spacing_mm: DVec3,
    /// Bytes before the first voxel.
    #[arg(long = "raw-skip", value_name = "BYTES", default_value_t = 0, requires = "dims")]
    pub skip_bytes: u64,
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

/// Bits per voxel in a store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BitsArg {
    /// 256 steps of each brick's own range.
    #[value(name = "8")]
    Eight,
    /// 65536 steps.
    #[value(name = "16")]
    Sixteen,
}

/// Compression of bricks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CodecArg {
    /// Fast and lossless.
    Lz4,
    /// As they are.
    None,
}

/// Byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EndianArg {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

fn point(text: &str) -> Result<DVec3, String> {
    let point = DVec3::from_array(three::<f64>(text)?);
    if point.is_finite() { Ok(point) } else { Err("give three finite numbers".to_owned()) }
}

fn spacing(text: &str) -> Result<DVec3, String> {
    let spacing = point(text)?;
    if spacing.min_element() > 0.0 { Ok(spacing) } else { Err("give lengths above 0".to_owned()) }
}

fn dims(text: &str) -> Result<UVec3, String> {
    let dims = UVec3::from_array(three::<u32>(text)?);
    if dims.min_element() > 0 { Ok(dims) } else { Err("give sizes of at least 1".to_owned()) }
}

fn three<T: std::str::FromStr>(text: &str) -> Result<[T; 3], String> {
    let parts = text.split(',').map(|part| part.trim().parse::<T>().ok()).collect::<Option<Vec<T>>>();
    parts
        .and_then(|p| p.try_into().ok())
        .ok_or_else(|| "give three numbers with commas between them".to_owned())
}

fn frame_range(text: &str) -> Result<(u32, u32), String> {
    let range =
        text.split_once("..").and_then(|(a, b)| Some((a.trim().parse().ok()?, b.trim().parse().ok()?)));
    range
        .filter(|(a, b)| a < b)
        .ok_or_else(|| "give a rising range such as 0..10, its end not included".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn simulate(arguments: &[&str]) -> Result<SimulateArgs, clap::Error> {
        let all = ["lightloom", "simulate", "procedural:shells", "--out", "o"].iter().chain(arguments);
        Cli::try_parse_from(all).map(|cli| match cli.command {
            Command::Simulate(args) => args,
            other => panic!("{other:?}"),
        })
    }

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn eyes_may_be_left_of_the_centre() {
        let args = simulate(&["--eye", "-0.3,0,3", "--eye=0.3, 0, 3", "--frames", "2..5"]).unwrap();
        assert_eq!(args.eyes, [DVec3::new(-0.3, 0.0, 3.0), DVec3::new(0.3, 0.0, 3.0)]);
        assert_eq!(args.frames, Some((2, 5)));
    }

    #[test]
    fn nonsense_is_a_usage_error() {
        for wrong in [
            ["--eye", "1,2"],
            ["--eye", "nan,0,1"],
            ["--frames", "5..5"],
            ["--frames", "3"],
            ["--backends", "0"],
            ["--cache-mib", "0"],
            ["--device", "tpu"],
        ] {
            assert_eq!(simulate(&wrong).unwrap_err().exit_code(), 2, "{wrong:?}");
        }
    }

    #[test]
    fn raw_voxels_need_size_and_type() {
        let import = |rest: &[&str]| {
            let all = ["lightloom", "import", "a.raw", "-o", "a.lloom"].iter().chain(rest);
            Cli::try_parse_from(all).map(|_| ()).map_err(|e| e.exit_code())
        };
        assert_eq!(import(&["--raw-dims", "2,3,4"]), Err(2));
        assert_eq!(import(&["--raw-type", "int16"]), Err(2));
        assert_eq!(import(&["--raw-dims", "2,3,4", "--raw-type", "int16", "--bits", "16"]), Ok(()));
        assert_eq!(import(&["--raw-dims", "2,3,0", "--raw-type", "int16"]), Err(2));
    }
}
