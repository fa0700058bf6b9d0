//! A back-end as a process of its own: one rank of an MPI job, or the renderer that such a rank keeps.

use backend::{open_renderer, start_log};
use std::process::ExitCode;
use transport::keeping::kept;
use transport::launch::HOW_TO_LAUNCH;
use transport::rank::{FRONTEND_SILENCE, work};
use transport::under_mpi;

fn main() -> ExitCode {
    if let Some(keeper) = kept::keeper() {
        start_log();
        return kept::work(open_renderer, keeper);
    }
    if !under_mpi() {
        eprintln!("lightloom-backend: it does nothing alone; start it with a front-end: `{HOW_TO_LAUNCH}`");
        return ExitCode::from(2);
    }
    start_log();
    work(open_renderer, FRONTEND_SILENCE)
}
