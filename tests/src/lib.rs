//! Shared parts of the tests and benchmarks that span crates: scenes, truth, comparison.

pub mod askew;
pub mod blending_scenes;
pub mod borders;
pub mod calibrated;
pub mod closure_volume;
pub mod cold_start;
#[cfg(unix)]
pub mod comeback;
pub mod compare;
pub mod data;
pub mod draw;
pub mod faulty_source;
#[cfg(unix)]
pub mod four_outputs;
pub mod head;
pub mod ideal_cut;
#[cfg(unix)]
pub mod machine;
pub mod made_once;
pub mod memory;
pub mod motion;
pub mod octaves;
pub mod phantoms;
pub mod picture_difference;
pub mod points;
pub mod presented;
#[cfg(unix)]
pub mod processes;
#[cfg(unix)]
pub mod program;
#[cfg(test)]
mod program_list;
pub mod random;
pub mod random_scene;
pub mod remembered;
pub mod results;
pub mod scanned_head;
pub mod scenes;
pub mod techniques;
pub mod twin_scene;
#[cfg(unix)]
pub mod wayland_desktop;
#[cfg(unix)]
pub mod x_server;
