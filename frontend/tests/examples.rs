//! The small programs in `examples` do what they show. `cargo test` builds them beside the tests, so run all of
//! `cargo test -p frontend`, or build them first with `cargo build --examples`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// An example, in the folder that cargo puts examples into: beside the one of this test.
fn example(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("a test knows its program");
    let folder = test.parent().and_then(Path::parent).expect("tests lie two folders below the target folder");
    folder.join("examples").join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

/// What an example prints; the test fails if it does.
fn run(name: &str, arguments: &[&Path]) -> String {
    let path = example(name);
    let output = Command::new(&path).args(arguments).output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{name}: {printed}{}", String::from_utf8_lossy(&output.stderr));
    printed
}

#[test]
fn minimal_simulate_writes_a_picture_for_every_projector() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let printed = run("minimal_simulate", &[folder.path()]);
    assert!(printed.starts_with("8 pictures"), "{printed}");
    let pictures = std::fs::read_dir(folder.path().join("frame-0000")).expect("the pictures have a folder");
    assert_eq!(pictures.count(), 8);
}

#[test]
fn minimal_store_builds_a_store_and_reads_a_brick() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let printed = run("minimal_store", &[folder.path()]);
    assert!(folder.path().join("shells.lloom").is_file());
    assert!(printed.contains("finest depth 2") && printed.contains("its first voxel"), "{printed}");
}

#[test]
fn minimal_reference_reaches_its_tolerance() {
    let printed = run("minimal_reference", &[]);
    assert!(printed.contains("within the tolerance: true"), "{printed}");
}
