//! `lightloom`: parses the command line, runs the command, and prints one sentence if it fails.

use clap::Parser;
use frontend::FrontendError;
use frontend::accuracy::AccuracyError;
use frontend::cli::Cli;
use frontend::interrupt::EXIT_CODE as INTERRUPTED;
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::try_parse().unwrap_or_else(|error| usage(&error));
    backend::start_log();
    match frontend::command::run(&cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        // Only this process is at work then, so nothing else has to be ended.
        Err(error @ (FrontendError::Stopped(_) | FrontendError::Accuracy(AccuracyError::Stopped))) => {
            complain(&error.to_string());
            std::process::exit(INTERRUPTED)
        }
        Err(error) => transport::fail("lightloom", &error.to_string()),
    }
}

/// Help goes to standard output; a usage error is a sentence of ours and exit code 2.
fn usage(error: &clap::Error) -> ! {
    if error.use_stderr() {
        complain(error.render().to_string().trim_start_matches("error: ").trim_end());
    } else {
        let _ = error.print();
    }
    std::process::exit(error.exit_code())
}

/// Prints on standard error. Unlike `eprintln!` it does not panic if the reader is gone.
fn complain(sentence: &str) {
    let _ = writeln!(std::io::stderr(), "lightloom: {sentence}");
}
