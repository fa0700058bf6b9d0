//! A back-end as a process of its own: one rank of an MPI job.

use backend::{open_renderer, start_log};
use std::process::ExitCode;
use transport::cluster::{FRONTEND_SILENCE, work};
use transport::launch::HOW_TO_LAUNCH;
use transport::under_mpi;

fn main() -> ExitCode {
    if !under_mpi() {
        eprintln!("lightloom-backend: it does nothing alone; start it with a front-end: `{HOW_TO_LAUNCH}`");
        return ExitCode::from(2);
    }
    start_log();
    work(open_renderer, FRONTEND_SILENCE)
}
