//! Pictures and stores against the truth, and the kernel against its twin: everything that a tolerance decides.
//!
//! One program, so that the tests share what costs the most: imported volumes and pictures by the reference. Tests that
//! draw hold [`lightloom_tests::draw::turn`]: each uses all cores, and a GPU serves one at a time.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod blending;
mod debug_views;
mod depth_marks;
mod deviation;
mod devices;
mod eye;
mod finish;
mod flat_layers;
mod hard_cases;
mod idle_tools;
mod laws;
mod layers;
mod lean_twins;
mod non_finite;
mod packets;
mod paper;
mod planes;
mod planes_in_hard_cases;
mod planes_on_gpu;
mod planes_shared;
mod planes_techniques;
mod random;
mod random_canaries;
mod reference;
mod refraction;
mod round_trip;
mod single_precision;
mod techniques;
mod thin_media;
mod twin;
