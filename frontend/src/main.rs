//! `lightloom`: parses the command line, runs the command, and prints one sentence if it fails.

use clap::Parser;
use clap::error::ErrorKind;
use display_config::text::brief_text;
use frontend::FrontendError;
use frontend::accuracy::AccuracyError;
use frontend::adapter::dismiss_backends;
use frontend::cli::Cli;
use frontend::command::print;
use frontend::interrupt;
use std::io::{IsTerminal, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::try_parse().unwrap_or_else(|error| usage(&error));
    backend::start_log();
    match frontend::command::run(&cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        // Only this process is at work then, so nothing else has to be ended.
        Err(error @ (FrontendError::Stopped(_) | FrontendError::Accuracy(AccuracyError::Stopped))) => {
            complain(&error.to_string());
            std::process::exit(interrupt::exit_code())
        }
        Err(error) => transport::fail("lightloom", &error.to_string()),
    }
}

/// Help and version go to standard output. A usage error is a sentence of ours and exit code 2; who gave no arguments at
/// all gets the help with it.
fn usage(error: &clap::Error) -> ! {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            let text = error.render();
            let text =
                if std::io::stdout().is_terminal() { text.ansi().to_string() } else { text.to_string() };
            let told = dismiss_backends().and_then(|()| print(&text));
            match told {
                Ok(()) => std::process::exit(0),
                Err(error) => transport::fail("lightloom", &error.to_string()),
            }
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let _ = write!(std::io::stderr(), "{}", error.render());
        }
        ErrorKind::InvalidUtf8 => {
            let names = std::env::args_os().filter(|name| name.to_str().is_none());
            let names: Vec<_> = names.map(|name| brief_text(&name.to_string_lossy()).into_owned()).collect();
            complain(&format!(
                "this command takes names in UTF-8 alone, and {} is none: rename it, or link to it by another name",
                names.join(" ")
            ));
        }
        _ => complain(error.render().to_string().trim_start_matches("error: ").trim_end()),
    }
    std::process::exit(error.exit_code())
}

/// Prints on standard error. Unlike `eprintln!` it does not panic if the reader is gone.
fn complain(sentence: &str) {
    let _ = writeln!(std::io::stderr(), "lightloom: {sentence}");
}
