//! How messages travel: threads in one process, or MPI.
//!
//! | file | what it is |
//! | --- | --- |
//! | `session` | the front-end's side: set up, draw frames, name whoever is lost |
//! | `limits` | how long back-ends may keep it waiting |
//! | `worker` | a back-end's side: the thread that passes messages on |
//! | `render_loop` | a back-end's thread that draws |
//! | `threads` | back-ends as threads of this process |
//! | `cluster` | back-ends as ranks of an MPI job: the front-end's end |
//! | `rank` | a back-end's end, in its rank |
//! | `introduction` | the first message between two ranks |
//! | `rest` | when ranks may look for messages now and then only |
//! | `restarts` | how long to wait before a renderer is started again |
//! | `keeping` | a rank that keeps a renderer as its child, and starts it again |
//! | `mpi` | bytes between ranks, the only file that calls MPI |
//! | `roster`, `watchdog`, `process` | who takes part, and who is still there |
//! | `launch` | how this process was started, and how it ends when a run cannot go on |

pub mod beat;
#[cfg(feature = "mpi")]
pub mod cluster;
#[cfg(feature = "mpi")]
mod introduction;
#[cfg(feature = "mpi")]
pub mod keeping;
pub mod launch;
mod limits;
mod link;
#[cfg(feature = "mpi")]
mod mpi;
mod opened;
#[cfg(feature = "mpi")]
mod pause;
mod process;
#[cfg(feature = "mpi")]
pub mod rank;
mod render_loop;
#[cfg(feature = "mpi")]
mod rest;
#[cfg(test)]
mod restart_tests;
mod restarts;
#[cfg(feature = "mpi")]
mod roster;
pub mod session;
mod session_error;
#[cfg(test)]
mod session_fixtures;
pub mod threads;
#[cfg(feature = "mpi")]
mod watchdog;
pub mod worker;

pub use launch::{Launch, fail, launch, local_rank, under_mpi};
pub use limits::Limits;
pub use link::{Link, LinkError, WorkerLink};
pub use opened::Opened;
pub use session::Session;
pub use session_error::SessionError;
pub use worker::{WorkerError, serve};
