//! Row planes against single rays: seconds next to the error at which they were measured.
//!
//! `cargo bench -p lightloom-tests --bench planes`; LIGHTLOOM_BENCH_PARTS="cpu,front,scaling" takes some of its parts,
//! LIGHTLOOM_BENCH_SCENES="name;name" some scenes of the first two, LIGHTLOOM_BENCH_RAY_VIEWS=n casts n views ray by ray in the first
//! (0: none), and LIGHTLOOM_BENCH_REPEATS=n draws each n times.

mod front;
mod measure;
mod scaling;
mod scene;
mod table;

/// A part by its name: what it measures.
type Part = (&'static str, fn(&std::path::Path) -> Result<(), String>);

const PARTS: [Part; 3] = [("cpu", table::run), ("front", front::run), ("scaling", scaling::run)];

fn main() -> Result<(), String> {
    let wanted = std::env::var("LIGHTLOOM_BENCH_PARTS").unwrap_or_default();
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    for (name, run) in PARTS {
        if wanted.is_empty() || wanted.split(',').any(|part| part == name) {
            run(folder.path())?;
        }
    }
    Ok(())
}
