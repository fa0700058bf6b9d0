//! The renderer of one back-end. A frame is begun, gone on with and presented; whoever draws it may leave off between any
//! two tiles, and begin another in its place.
//!
//! Every frame is a course of rounds: cast some rays, learn what they found too coarse, step the working set. A live
//! frame is one round that shows what there is. A complete frame is rounds without fades and without a limit of uploads,
//! view by view, until nothing is missing.

mod account;
mod ancestors;
mod brick_ranges;
mod caster;
mod closeness;
mod complete;
mod course;
mod damage;
#[cfg(test)]
mod damage_tests;
mod easing;
mod engine;
mod error;
#[cfg(test)]
mod expect_tests;
mod feedback;
mod finals;
#[cfg(test)]
mod interrupt_tests;
mod known;
mod live;
mod live_memory;
mod marks;
#[cfg(test)]
mod mirror_tests;
mod parts;
mod recording;
#[cfg(test)]
mod recording_tests;
mod refining;
#[cfg(test)]
mod refining_tests;
mod renderer;
mod report;
mod rules;
mod setting;
mod shelf;
#[cfg(test)]
mod short_tests;
mod stock;
#[cfg(test)]
mod sub_frame_tests;
mod table_cache;
#[cfg(test)]
mod test_scene;
#[cfg(test)]
mod together_tests;
mod views;
mod work;

pub use error::RenderError;
pub use renderer::Renderer;
