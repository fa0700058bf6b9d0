//! The command line.

mod accuracy;
mod backends;
mod calibrate;
mod debug_view;
mod drive;
mod exhibit;
mod export;
mod gallery;
mod import;
mod info;
mod inputs;
mod live;
mod looks;
mod outputs;
mod parse;
mod replay;
mod simulate;
mod tape;
#[cfg(test)]
mod tests;
mod tune;
mod verify;

pub use accuracy::AccuracyArgs;
pub use backends::{BackendArgs, DeviceArg, FilterArg};
pub use calibrate::{CalibrateArgs, CalibrateSubject, TrackerArgs};
pub use debug_view::DebugViewArg;
pub use drive::{DriveArgs, OutputArg, ReconstructArg, ShowArgs, SwapchainArg};
pub use exhibit::ExhibitArgs;
pub use export::ExportArgs;
pub use gallery::GalleryArgs;
pub use import::{BitsArg, CodecArg, EndianArg, ImportArgs, PickArgs, RawArgs};
pub use info::InfoArgs;
pub use inputs::InputsArgs;
pub use live::LiveArgs;
pub use looks::LooksArgs;
pub use outputs::OutputsArgs;
pub use replay::{DiskArg, FetchOrderArg, ReplayArgs};
pub use simulate::SimulateArgs;
pub use tape::{TableArg, TapeAction, TapeArgs};
pub use tune::{TapeChoice, TuneArgs};
pub use verify::VerifyArgs;

use clap::{Parser, Subcommand};

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
    /// Render what every projector of a display shows, and what eyes in front of it see.
    Simulate(SimulateArgs),
    /// Drive a display: frame after frame, at its rate, with all projectors in step.
    Drive(DriveArgs),
    /// Run an exhibit: several visitors with tools, a programme, all day.
    Exhibit(ExhibitArgs),
    /// Say what is on a tape of a show, cut it, or write it as a table.
    Tape(TapeArgs),
    /// Show each illustrative technique off and on, as eyes in front of a display see it, on one page.
    Gallery(GalleryArgs),
    /// Show a volume in every look of the library, on one page.
    Looks(LooksArgs),
    /// Turn a volume file, or a folder of slices, into a store of bricks.
    Import(ImportArgs),
    /// Write a level of a store, or a part of it, as NRRD or OME-Zarr.
    Export(ExportArgs),
    /// Describe what a store holds.
    Info(InfoArgs),
    /// Read and check every byte of a store.
    Verify(VerifyArgs),
    /// Measure error and time of many settings against the reference, and draw them as plots.
    Accuracy(AccuracyArgs),
    /// Find the best frame control: interaction played to simulated machines, as an eye sees it.
    Tune(TuneArgs),
    /// Replay recorded traces under other policies, without drawing anything.
    Replay(ReplayArgs),
    /// Find where devices are, by measurement.
    Calibrate(CalibrateArgs),
    /// List the displays that come with the program.
    Displays,
    /// List the video outputs of this host, for the projectors of a display file.
    Outputs(OutputsArgs),
    /// Show live what trackers, controllers and programs say.
    Inputs(InputsArgs),
}
