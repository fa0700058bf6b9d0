//! The arguments of `lightloom info`.

use clap::Args;
use std::path::PathBuf;

/// `lightloom info`.
#[derive(Clone, Debug, Args)]
pub struct InfoArgs {
    /// The .lloom store.
    pub store: PathBuf,
    /// Print it as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}
