//! The commands: from arguments to what they print.

mod accuracy;
mod calibrate;
mod displays;
mod drive;
mod exhibit;
mod export;
mod gallery;
mod import;
mod info;
mod inputs;
mod look;
mod looks;
mod outputs;
mod replay;
mod say;
mod show;
mod simulate;
mod table;
mod tape;
mod tune;
mod verify;

pub use say::print;

use crate::cli::Command;
use crate::{FrontendError, adapter};

/// Does what the command line asks for. Back-ends that a launcher started and that have nothing to draw are let go
/// before that.
pub fn run(command: &Command) -> Result<(), FrontendError> {
    if !matches!(
        command,
        Command::Simulate(_)
            | Command::Drive(_)
            | Command::Exhibit(_)
            | Command::Gallery(_)
            | Command::Looks(_)
    ) {
        adapter::dismiss_backends()?;
    }
    match command {
        Command::Simulate(args) => simulate::simulate(args),
        Command::Drive(args) => drive::drive(args),
        Command::Exhibit(args) => exhibit::exhibit(args),
        Command::Tape(args) => tape::tape(args),
        Command::Gallery(args) => gallery::gallery(args),
        Command::Looks(args) => looks::looks(args),
        Command::Import(args) => import::import(args),
        Command::Info(args) => info::info(args),
        Command::Verify(args) => verify::verify(args),
        Command::Export(args) => export::export(args),
        Command::Accuracy(args) => accuracy::accuracy(args),
        Command::Tune(args) => tune::tune(args),
        Command::Replay(args) => replay::replay(args),
        Command::Calibrate(args) => calibrate::calibrate(args),
        Command::Displays => displays::displays(),
        Command::Outputs(args) => outputs::outputs(args),
        Command::Inputs(args) => inputs::inputs(args),
    }
}
