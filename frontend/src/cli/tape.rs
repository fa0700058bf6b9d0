//! The arguments of `lightloom tape`.

use super::parse::seconds;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;

/// `lightloom tape`.
#[derive(Clone, Debug, Args)]
pub struct TapeArgs {
    /// What to do with it.
    #[command(subcommand)]
    pub action: TapeAction,
}

/// What can be done with a tape.
#[derive(Clone, Debug, Subcommand)]
pub enum TapeAction {
    /// Say what is on it.
    Info {
        /// The tape.
        tape: PathBuf,
        /// As JSON.
        #[arg(long)]
        json: bool,
    },
    /// Write a part of it as a tape of its own, which begins with tools and buttons as they were then.
    Cut {
        /// The tape.
        tape: PathBuf,
        /// Where the part begins, seconds after the first frame. [default: the beginning]
        #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
        from: Option<Duration>,
        /// Where it ends. [default: the end]
        #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
        to: Option<Duration>,
        /// The new tape.
        #[arg(long, value_name = "TAPE.mcap")]
        out: PathBuf,
    },
    /// Write its records as a table on standard output.
    Export {
        /// The tape.
        tape: PathBuf,
        /// How the table is written.
        #[arg(long = "as", value_enum, default_value = "csv")]
        format: TableArg,
    },
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableArg {
    /// A line of values for each record.
    Csv,
    /// A JSON object on a line for each record.
    Json,
}
