//! Row planes against single rays: seconds next to the error at which they were measured.
//!
//! `cargo bench -p lightloom-tests --bench planes`; LIGHTLOOM_BENCH_PARTS="cpu,packets,looks,front,scaling" takes some of its parts,
//! LIGHTLOOM_BENCH_SCENES="name;name" some scenes of those with a table of them, LIGHTLOOM_BENCH_RAY_VIEWS=n casts n views ray by ray in the first
//! (0: none), and LIGHTLOOM_BENCH_REPEATS=n draws each n times.

mod front;
mod looks;
mod measure;
mod packets;
mod scaling;
mod scene;
mod sweep;
mod table;

use std::cell::LazyCell;

fn main() -> Result<(), String> {
    let parts = std::env::var("LIGHTLOOM_BENCH_PARTS").unwrap_or_default();
    let is_wanted = |name| parts.is_empty() || parts.split(',').any(|part| part == name);
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let scenes = LazyCell::new(|| scene::wanted(folder.path()));
    if is_wanted("cpu") {
        table::run(&scenes)?;
    }
    if is_wanted("packets") {
        packets::run(&scenes)?;
    }
    if is_wanted("looks") {
        looks::run()?;
    }
    if is_wanted("front") {
        front::run(&scenes)?;
    }
    if is_wanted("scaling") {
        scaling::run()?;
    }
    Ok(())
}
