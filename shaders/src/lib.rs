//! The picture in WGSL: modules in `wgsl/`, and the kernels composed of them. Beside each module there is a Rust twin,
//! in the crate `twin`.
//!
//! This crate knows how a kernel is composed. It knows no GPU library, no file and no process: a device in the
//! back-end runs what is composed here.

pub mod compose;
