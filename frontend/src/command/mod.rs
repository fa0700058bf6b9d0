//! The commands: from arguments to what they print.

mod accuracy;
mod displays;
mod export;
mod gallery;
mod import;
mod info;
mod replay;
mod say;
mod simulate;
mod table;
mod verify;

use crate::FrontendError;
use crate::cli::Command;

/// Does what the command line asks for.
pub fn run(command: &Command) -> Result<(), FrontendError> {
    match command {
        Command::Simulate(args) => simulate::simulate(args),
        Command::Gallery(args) => gallery::gallery(args),
        Command::Import(args) => import::import(args),
        Command::Info(args) => info::info(args),
        Command::Verify(args) => verify::verify(args),
        Command::Export(args) => export::export(args),
        Command::Accuracy(args) => accuracy::accuracy(args),
        Command::Replay(args) => replay::replay(args),
        Command::Displays => displays::displays(),
    }
}
