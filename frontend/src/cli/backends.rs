//! The arguments that choose what draws the pictures.

use super::parse::whole;
use crate::adapter::BackendOptions;
use clap::{Args, ValueEnum};
use protocol::{CasterChoice, DeviceChoice, FilterChoice};
use std::path::Path;

/// Back-ends, their devices and their caches.
#[derive(Clone, Debug, Args)]
pub struct BackendArgs {
    /// How many back-ends share the projectors; 1 unless a launcher started more.
    #[arg(long, value_name = "N", value_parser = whole(1..=u32::MAX), allow_hyphen_values = true)]
    pub backends: Option<u32>,
    /// Which device casts the rays.
    #[arg(long, value_enum, default_value = "auto")]
    pub device: DeviceArg,
    /// How voxels are interpolated.
    #[arg(long, value_enum, default_value = "auto")]
    pub filter: FilterArg,
    /// What casts the rays.
    #[arg(long, value_enum, default_value = "auto")]
    pub caster: CasterArg,
    /// Brick cache of each back-end.
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = whole(1..=1_u64 << 30), allow_hyphen_values = true)]
    pub cache_mib: u64,
}

impl BackendArgs {
    /// What the back-ends draw with, and the folder for their traces.
    pub fn options(&self, traces: Option<&Path>) -> BackendOptions {
        BackendOptions {
            device: self.device.into(),
            filter: self.filter.into(),
            caster: self.caster.into(),
            cache_bytes: self.cache_mib << 20,
            traces: traces.map(Path::to_owned),
        }
    }
}

/// See [`DeviceChoice`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeviceArg {
    /// A hardware GPU if there is one, the CPU otherwise.
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

/// See [`CasterChoice`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CasterArg {
    /// Planes on the CPU where they can draw the scene, many projectors share them and the tolerance is not below 3e-5; rays
    /// elsewhere.
    Auto,
    /// Each ray alone.
    Rays,
    /// Each screen row sampled once for all views: several times faster, and less exact.
    Planes,
}

impl From<CasterArg> for CasterChoice {
    fn from(caster: CasterArg) -> Self {
        match caster {
            CasterArg::Auto => CasterChoice::Auto,
            CasterArg::Rays => CasterChoice::Rays,
            CasterArg::Planes => CasterChoice::Planes,
        }
    }
}
