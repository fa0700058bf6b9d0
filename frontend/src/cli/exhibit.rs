//! The arguments of `lightloom exhibit`.

use super::ShowArgs;
use clap::Args;
use std::path::PathBuf;

/// `lightloom exhibit`.
#[derive(Clone, Debug, Args)]
pub struct ExhibitArgs {
    /// An exhibit: a .toml file that names display, scenes, visitors and tools.
    pub file: PathBuf,
    /// Say everything that is wrong with it, and show nothing.
    #[arg(long)]
    pub check: bool,
    /// Keep how it goes in this file, as JSON, written anew each second.
    #[arg(long, value_name = "STATUS.json")]
    pub status: Option<PathBuf>,
    /// Keep what happens in this log, line by line, and its five predecessors of 10 MB.
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// How it is shown.
    #[command(flatten)]
    pub show: ShowArgs,
}
