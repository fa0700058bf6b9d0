//! The arguments of `lightloom calibrate`.

use clap::{Args, Subcommand};
use std::path::PathBuf;

/// `lightloom calibrate`.
#[derive(Clone, Debug, Args)]
pub struct CalibrateArgs {
    /// What is calibrated.
    #[command(subcommand)]
    pub subject: CalibrateSubject,
}

/// What can be calibrated.
#[derive(Clone, Debug, Subcommand)]
pub enum CalibrateSubject {
    /// Find where a tracker is, from points that both it and the display know.
    Tracker(TrackerArgs),
}

/// `lightloom calibrate tracker`.
#[derive(Clone, Debug, Args)]
pub struct TrackerArgs {
    /// The .toml file of point pairs.
    pub pairs: PathBuf,
    /// A display whose viewing zone errors are told for: a preset's name (see `lightloom displays`) or a .toml file.
    #[arg(long, value_name = "DISPLAY")]
    pub display: Option<String>,
    /// Write the transform into this file, for an exhibit; without it, it is printed.
    #[arg(long, value_name = "TRACKER.toml")]
    pub out: Option<PathBuf>,
    /// Print everything as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}
