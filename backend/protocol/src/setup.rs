//! What is agreed once, before the first frame.

use display_config::Display;
use glam::{DVec3, UVec3};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Which device casts the rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DeviceChoice {
    /// A hardware GPU if there is one, the CPU otherwise.
    #[default]
    Auto,
    /// The GPU or nothing.
    Gpu,
    /// The kernels' f32 twin on all cores.
    Cpu,
}

/// How a kernel interpolates voxels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FilterChoice {
    /// The texture unit where it was measured to be precise on this adapter, exact otherwise.
    #[default]
    Auto,
    /// The texture unit, whatever its precision.
    Hardware,
    /// Eight fetches, interpolated in f32.
    Exact,
}

/// What casts the rays of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CasterChoice {
    /// What is as exact as the frame asks: each ray alone.
    #[default]
    Auto,
    /// Each ray alone.
    Rays,
    /// Row planes, or an error.
    Planes,
}

/// Which of a host's graphics adapters.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AdapterWish {
    /// Which of the back-ends of its host this is, counted from any number on: back-ends take turns where several adapters
    /// fit.
    pub turn: u32,
    /// Part of the adapter's name, in capitals or not; None for any of the best kind.
    pub name: Option<String>,
}

/// Which volume.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum VolumeRef {
    /// A brick store, at a path that every back-end can read.
    Store(PathBuf),
    /// A procedural volume by name ("shells", "marschner-lobb", "sparse-vessels") and size in voxels.
    Procedural {
        /// Its name without the `procedural:` in front.
        name: String,
        /// Voxels along each axis.
        dims: UVec3,
        /// Edge lengths of a voxel, metres.
        voxel_size_m: DVec3,
    },
}

/// What a renderer is made with, besides its volume.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RendererOptions {
    /// The whole display.
    pub display: Display,
    /// The projectors to draw, as indices into the display.
    pub projectors: Vec<u32>,
    /// Number of the back-end that it draws for, from 0: its reports carry it.
    pub backend: u32,
    /// The device.
    pub device: DeviceChoice,
    /// The adapter, where the device is a GPU.
    pub adapter: AdapterWish,
    /// The interpolation.
    pub filter: FilterChoice,
    /// The caster.
    pub caster: CasterChoice,
    /// Size of the brick cache, bytes.
    pub cache_bytes: u64,
}

impl RendererOptions {
    /// Back-end 0 of this process, on the CPU, with a brick cache of 64 MiB.
    pub fn in_process(display: Display, projectors: Vec<u32>) -> Self {
        Self {
            display,
            projectors,
            backend: 0,
            device: DeviceChoice::Cpu,
            adapter: AdapterWish::default(),
            filter: FilterChoice::Auto,
            caster: CasterChoice::Auto,
            cache_bytes: 64 << 20,
        }
    }
}

/// Whether a GPU paints the windows of its back-end itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SwapchainChoice {
    /// Where it is a GPU in hardware and can; otherwise pictures go to windows by way of main memory.
    #[default]
    Auto,
    /// It does, or an error.
    On,
    /// It does not.
    Off,
}

/// Where the pictures of a driven display go; nowhere, they are drawn and timed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Screens {
    /// To the front-end, as codes.
    pub frontend: bool,
    /// Onto the outputs that the display names, in windows of the back-end.
    pub outputs: bool,
    /// How they get into these windows.
    pub swapchain: SwapchainChoice,
}

/// The first message to a back-end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setup {
    /// What its renderer is made with.
    pub options: RendererOptions,
    /// The volume.
    pub volume: VolumeRef,
    /// Where to write the trace of the working set in live frames; None where none is wanted.
    pub trace: Option<PathBuf>,
    /// Where the pictures of its beat go.
    pub screens: Screens,
    /// Whether its rank keeps it as a process of its own, which is started again when it ends. Threads are anyway.
    pub is_kept: bool,
    /// What the one before it showed, where it takes the place of one.
    pub held: Option<Box<Held>>,
}

/// The bricks of a volume that a back-end shows, for whoever takes its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// The volume.
    pub volume: VolumeRef,
    /// Depth and cell of each node.
    pub nodes: Vec<(u8, UVec3)>,
}

/// What a back-end says of itself when it starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hello {
    /// [`super::PROTOCOL_VERSION`] of the back-end.
    pub protocol: u32,
    /// Host name.
    pub host: String,
    /// Process number on that host.
    pub process: u32,
}

/// The device a back-end ended up with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeviceInfo {
    /// For instance `gpu: llvmpipe (LLVM 15.0.6, 256 bits), Vulkan` or `cpu: 2 threads`.
    pub adapter: String,
    /// Why this one: a sentence.
    pub reason: String,
    /// The interpolation in use: `hardware` or `exact`.
    pub filter: String,
    /// Bytes of its brick cache, which may be less than was asked for: no more than the volume has bricks, and on a GPU a
    /// power of two of them.
    pub cache_bytes: u64,
}
