//! Shared parts of the tests and benchmarks that span crates: scenes, truth, comparison.

pub mod borders;
pub mod closure_volume;
pub mod compare;
pub mod data;
pub mod draw;
pub mod head;
pub mod ideal_cut;
pub mod motion;
#[cfg(unix)]
pub mod program;
pub mod random;
pub mod random_scene;
pub mod remembered;
pub mod scenes;
pub mod techniques;
pub mod twin_scene;
