//! The arguments of `lightloom import`.

use super::parse::{dims, finite, spacing, whole};
use crate::adapter::{ImportRequest, RawRequest, Skipped};
use bricks::store::{CodeBits, Codec};
use bricks::volume::ByteOrder;
use clap::{Args, ValueEnum};
use glam::{DVec3, UVec3};
use std::path::PathBuf;

/// `lightloom import`.
#[derive(Clone, Debug, Args)]
pub struct ImportArgs {
    /// A volume file or a folder of its slices, a raw file, procedural:NAME or procedural:NAME@VOXELS.
    pub input: PathBuf,
    /// The store to write; its name ends in .lloom.
    #[arg(short, long, value_name = "OUT.lloom")]
    pub output: PathBuf,
    /// Bits per voxel in the store.
    #[arg(long, value_enum, default_value = "8")]
    pub bits: BitsArg,
    /// How bricks are compressed.
    #[arg(long, value_enum, default_value = "lz4")]
    pub codec: CodecArg,
    /// Memory for slabs, a quarter of it for the reader's; some 100 MiB come on top, for bricks under way and the program.
    #[arg(long = "memory", value_name = "MIB", default_value_t = 2048, value_parser = whole(1..=1_u64 << 30), allow_hyphen_values = true)]
    pub memory_mib: u64,
    /// Leave out bricks in which every value is below this one; they read back as their smallest value.
    #[arg(long, value_name = "VALUE", value_parser = finite, allow_hyphen_values = true, conflicts_with = "empty_for")]
    pub empty_below: Option<f64>,
    /// Leave out bricks that the transfer functions of this scene do not show.
    #[arg(long, value_name = "SCENE.toml")]
    pub empty_for: Option<PathBuf>,
    /// Keep the mean of the voxels that each coarse voxel represents, but not their standard deviation: the store is about an
    /// eighth smaller, and coarse levels show less of what they hold.
    #[arg(long)]
    pub no_deviation: bool,
    /// Which volume, if the input holds several.
    #[command(flatten)]
    pub pick: PickArgs,
    /// The voxels of a file without a header.
    #[command(flatten)]
    pub raw: RawArgs,
    /// No progress, no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Print what was done as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

impl ImportArgs {
    /// What to import, and how.
    pub fn request(&self) -> ImportRequest {
        let skipped = match (self.empty_below, &self.empty_for) {
            (Some(value), _) => Skipped::Below(value),
            (None, Some(scene)) => Skipped::UnseenIn(scene.clone()),
            (None, None) => Skipped::Uniform,
        };
        ImportRequest {
            input: self.input.clone(),
            output: self.output.clone(),
            bits: self.bits.into(),
            codec: self.codec.into(),
            memory_bytes: self.memory_mib << 20,
            skipped,
            has_deviation: !self.no_deviation,
            series: self.pick.series.clone(),
            level: self.pick.level,
            channel: self.pick.channel,
            time: self.pick.time,
            voxel_mm: self.pick.voxel_mm,
            raw: self.raw.request(),
        }
    }
}

/// Which of the volumes in an input, and what its files do not tell.
#[derive(Clone, Debug, Args)]
pub struct PickArgs {
    /// Of a folder with several DICOM series: its number in the list, from 1, or the start or end of its UID.
    #[arg(long, value_name = "SERIES")]
    pub series: Option<String>,
    /// Of a pyramid: the level, 0 = finest.
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX), allow_hyphen_values = true)]
    pub level: Option<u32>,
    /// Of several channels or samples per voxel: which one, from 0.
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX), allow_hyphen_values = true)]
    pub channel: Option<u32>,
    /// Of a time series: which point in time, from 0.
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX), allow_hyphen_values = true)]
    pub time: Option<u32>,
    /// Edge lengths of a voxel in millimetres, overriding the file.
    #[arg(long = "spacing-mm", value_name = "X,Y,Z", value_parser = spacing, conflicts_with = "raw_spacing_mm", allow_hyphen_values = true)]
    pub voxel_mm: Option<DVec3>,
}

/// What a file without a header holds.
#[derive(Clone, Debug, Args)]
pub struct RawArgs {
    /// Voxels along x (fastest), y and z: the input is then read as raw voxels.
    #[arg(long = "raw-dims", value_name = "X,Y,Z", value_parser = dims, requires = "element", allow_hyphen_values = true)]
    pub dims: Option<UVec3>,
    /// Type of a voxel: uint8, int16, float, …
    #[arg(long = "raw-type", value_name = "TYPE", requires = "dims")]
    pub element: Option<String>,
    /// Byte order of a voxel.
    #[arg(long = "raw-endian", value_enum, default_value = "little", requires = "dims")]
    pub endian: EndianArg,
    /// Edge lengths of a voxel, millimetres.
    #[arg(long = "raw-spacing-mm", value_name = "X,Y,Z", value_parser = spacing, default_value = "1,1,1", requires = "dims", allow_hyphen_values = true)]
    pub raw_spacing_mm: DVec3,
    /// Bytes before the first voxel.
    #[arg(
        long = "raw-skip",
        value_name = "BYTES",
        default_value_t = 0, value_parser = whole(0..=u64::MAX),
        requires = "dims",
        allow_hyphen_values = true
    )]
    pub skip_bytes: u64,
}

impl RawArgs {
    fn request(&self) -> Option<RawRequest> {
        Some(RawRequest {
            dims: self.dims?,
            element: self.element.clone()?,
            byte_order: self.endian.into(),
            spacing_mm: self.raw_spacing_mm,
            skip_bytes: self.skip_bytes,
        })
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

impl From<BitsArg> for CodeBits {
    fn from(bits: BitsArg) -> Self {
        match bits {
            BitsArg::Eight => CodeBits::Eight,
            BitsArg::Sixteen => CodeBits::Sixteen,
        }
    }
}

/// Compression of bricks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CodecArg {
    /// Fast and lossless.
    Lz4,
    /// Smaller, slower and lossless.
    Zstd,
    /// As they are.
    None,
}

impl From<CodecArg> for Codec {
    fn from(codec: CodecArg) -> Self {
        match codec {
            CodecArg::None => Codec::None,
            CodecArg::Lz4 => Codec::Lz4,
            CodecArg::Zstd => Codec::Zstd,
        }
    }
}

/// Byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EndianArg {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

impl From<EndianArg> for ByteOrder {
    fn from(order: EndianArg) -> Self {
        match order {
            EndianArg::Little => ByteOrder::Little,
            EndianArg::Big => ByteOrder::Big,
        }
    }
}
