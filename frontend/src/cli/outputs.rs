//! The arguments of `lightloom outputs`.

use clap::Args;

/// `lightloom outputs`.
#[derive(Clone, Debug, Args)]
pub struct OutputsArgs {
    /// Print the outputs as JSON on standard output, and nothing else.
    #[arg(long)]
    pub json: bool,
}
