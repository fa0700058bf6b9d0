//! The arguments of `lightloom verify`.

use clap::Args;
use std::path::PathBuf;

/// `lightloom verify`.
#[derive(Clone, Debug, Args)]
pub struct VerifyArgs {
    /// The .lloom store.
    pub store: PathBuf,
    /// No progress, no summary; only the exit code.
    #[arg(long)]
    pub quiet: bool,
    /// Print what was found as JSON on standard output.
    #[arg(long)]
    pub json: bool,
}
