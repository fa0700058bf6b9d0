//! A back-end as a process of its own: one rank of an MPI job.

use backend::transport::cluster::{FRONTEND_SILENCE, work};
use backend::transport::launch::HOW_TO_LAUNCH;
use backend::transport::{open_renderer, start_log, under_mpi};
use std::process::ExitCode;

fn main() -> ExitCode {
    if !under_mpi() {
        eprintln!("lightloom-backend: it does nothing alone; start it with a front-end: `{HOW_TO_LAUNCH}`");
        return ExitCode::from(2);
    }
    start_log();
    work(open_renderer, FRONTEND_SILENCE)
}
