//! The arguments of `lightloom inputs`.

use super::parse::seconds;
use clap::Args;
use std::path::PathBuf;
use std::time::Duration;

/// `lightloom inputs`.
#[derive(Clone, Debug, Args)]
pub struct InputsArgs {
    /// A .toml file with `[[input]]` entries.
    pub file: PathBuf,
    /// End after so many seconds; without it, Ctrl-C ends.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    pub time: Option<Duration>,
    /// Print a report as JSON on standard output in the end, and nothing else.
    #[arg(long)]
    pub json: bool,
}
