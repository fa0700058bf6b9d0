//! The rules of the house, read from the files themselves; each rule also has to find the fault in a spoiled house.

mod code;
mod crates;
mod modules;
mod shape;
mod sources;
mod twins;
mod unused;

/// Fails with the faults that were found, a line each.
#[track_caller]
fn assert_none(wrong: &[String]) {
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
