//! The picture, written twice: WGSL modules in `wgsl/`, and beside each its Rust twin, generic over f32 and f64.
//!
//! This crate knows how a kernel is composed. It knows no GPU library, no file and no process: a device in the
//! back-end runs what is composed here.

pub mod compose;
pub mod needs;
pub mod tables;
pub mod twin;
