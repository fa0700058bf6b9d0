//! The programs as users start them, alone and under mpirun.
#![cfg(unix)]
#![allow(
    clippy::unwrap_used,
    reason = "rules out what the test would fail on anyway; clippy knows the test functions only"
)]

mod accuracy;
mod bad_input;
mod bad_volumes;
mod calibrate;
mod calibrated;
mod careless;
mod comeback;
mod control;
mod drive;
mod exhibit;
mod export;
mod idle_backends;
mod import;
mod inputs;
mod live;
mod looks;
mod lost_backend;
mod outputs;
mod pipeline_cache;
mod replay;
mod same_bytes;
mod stopped;
mod store_commands;
mod tapes;
mod wayland;
mod whole_store;
mod window;
mod wiring;
