//! The study of tracking without the tests' crate around it: prints its tables.

#[path = "../../../tests/examples/tracking/study/mod.rs"]
mod study;

fn main() {
    study::tables(&mut |line| println!("{line}"));
}
