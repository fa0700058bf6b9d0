//! The arguments of `lightloom drive`.

use super::BackendArgs;
use super::live::{fade, live_pace, upload};
use super::parse::{seconds, whole};
use crate::scene::{LookName, QualityPreset};
use clap::{Args, ValueEnum};
use control::Rule;
use display_config::RATES_HZ;
use protocol::{Pace, SwapchainChoice};
use std::path::PathBuf;
use std::time::Duration;

/// `lightloom drive`.
#[derive(Clone, Debug, Args)]
pub struct DriveArgs {
    /// A .toml scene, a .lloom store, procedural:NAME or procedural:NAME@VOXELS with shells, marschner-lobb or sparse-vessels.
    pub scene: String,
    /// A display: a preset's name (see `lightloom displays`) or a .toml file.
    #[arg(long, value_name = "DISPLAY", default_value = "holo72")]
    pub display: String,
    /// Trackers and controllers, as `lightloom inputs` reads them: the first sensor of which a pose comes is the scene's `[tool]`.
    #[arg(long, value_name = "INPUTS.toml")]
    pub inputs: Option<PathBuf>,
    /// A look of the library; a scene's own [optics] win over it. Without it, the volume's values choose one.
    #[arg(long, value_name = "NAME", value_enum)]
    pub look: Option<LookName>,
    /// Quality, overriding the scene's.
    #[arg(long, value_enum)]
    pub quality: Option<QualityPreset>,
    /// How it is shown.
    #[command(flatten)]
    pub show: ShowArgs,
}

/// How a display is driven.
#[derive(Clone, Debug, Args)]
pub struct ShowArgs {
    /// What draws the pictures.
    #[command(flatten)]
    pub drawing: BackendArgs,
    /// Where the pictures go.
    #[arg(long, value_enum, default_value = "desktop")]
    pub output: OutputArg,
    /// Whether a GPU paints the windows on outputs itself, or their pictures go through main memory.
    #[arg(long, value_enum, default_value = "auto")]
    pub swapchain: SwapchainArg,
    /// A window on this desktop as well, wherever else the pictures go. Alone it is the same as --output desktop.
    #[arg(long)]
    pub desktop: bool,
    /// Frames per second instead of the display's.
    #[arg(long, value_name = "HZ", value_parser = rate, allow_hyphen_values = true)]
    pub rate: Option<f64>,
    /// Whether each frame casts a quarter of its pixels and reconstructs the others from these and the frames before: what
    /// moves comes four times as often, what rests is complete after four frames.
    #[arg(long, value_enum, default_value = "quincunx")]
    pub reconstruct: ReconstructArg,
    /// Decide what is cast and what is shown by `errors` in space and in time; or give every picture of what moves the same
    /// time, `rate=HZ`, or the same share of its rays, `quality=SHARE`. Then --reconstruct does not matter.
    #[arg(long, value_name = "RULE")]
    pub control: Option<Rule>,
    /// End after so many frames.
    #[arg(long, value_name = "N", value_parser = whole(1..=u32::MAX), allow_hyphen_values = true)]
    pub frames: Option<u32>,
    /// End after so many seconds.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    pub time: Option<Duration>,
    /// Time in which detail appears or disappears; 0 means at once. [default: 0.4]
    #[arg(long, value_name = "SECONDS", value_parser = fade, allow_hyphen_values = true)]
    pub fade: Option<f64>,
    /// How much one frame of a back-end may upload. [default: 64]
    #[arg(long, value_name = "N", value_parser = upload, allow_hyphen_values = true)]
    pub upload_mib: Option<u64>,
    /// Write what every projector shows in every frame into this folder, as PNG.
    #[arg(long, value_name = "DIR")]
    pub dump: Option<PathBuf>,
    /// Let time stand still while a frame is drawn, and let each wait for its detail: the same scene gives the same pictures,
    /// however many back-ends draw them. For --dump.
    #[arg(long)]
    pub stepped: bool,
    /// Play a tape in place of inputs: what reached the world when it was recorded. With --stepped its frames are made again
    /// one by one, and a warning tells if they are not what they were.
    #[arg(long, value_name = "TAPE.mcap")]
    pub tape: Option<PathBuf>,
    /// Keep everything that reaches the world on this tape.
    #[arg(long, value_name = "TAPE.mcap")]
    pub record: Option<PathBuf>,
    /// Folder for the report of the show; created if missing.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// No status line, no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Print the report as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}

/// Where the pictures go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OutputArg {
    /// All side by side into one window of this desktop, where mouse and keys handle the volume.
    Desktop,
    /// Each projector's to the output that the display file names for it, in a window that covers the output.
    Outputs,
    /// Nowhere: they are drawn and timed.
    None,
}

/// Which pixels a frame casts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ReconstructArg {
    /// A quarter of them (row planes: half); the others are reconstructed.
    Quincunx,
    /// All of them.
    Off,
}

/// What paints the windows on outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SwapchainArg {
    /// A hardware GPU where the X server shows with it, main memory elsewhere.
    Auto,
    /// The GPU or nothing.
    On,
    /// Main memory.
    Off,
}

impl From<SwapchainArg> for SwapchainChoice {
    fn from(swapchain: SwapchainArg) -> Self {
        match swapchain {
            SwapchainArg::Auto => SwapchainChoice::Auto,
            SwapchainArg::On => SwapchainChoice::On,
            SwapchainArg::Off => SwapchainChoice::Off,
        }
    }
}

impl ShowArgs {
    /// Whether there is a window on this desktop.
    pub fn has_desktop(&self) -> bool {
        self.desktop || self.output == OutputArg::Desktop
    }

    /// How frames get their detail.
    pub fn pace(&self) -> Pace {
        live_pace(self.upload_mib, self.fade)
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let (low, high) = RATES_HZ;
    let rate = text.trim().parse().ok().filter(|rate| (low..=high).contains(rate));
    rate.ok_or_else(|| format!("give a number of frames per second from {low} to {high}"))
}
