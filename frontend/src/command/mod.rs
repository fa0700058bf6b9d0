//! The commands: from arguments to what they print.

mod accuracy;
mod displays;
mod export;
mod gallery;
mod import;
mod info;
mod replay;
mod simulate;
mod table;
mod verify;

use crate::FrontendError;
use crate::cli::Command;
use std::io::Write;

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

/// Prints on standard output. Unlike `println!` it does not panic if the reader is gone.
fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    // Whoever closed standard output does not want the rest.
    let _ = writeln!(out, "{text}").and_then(|()| out.flush());
}

/// Prints a warning on standard error.
fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "lightloom: warning: {text}");
}
