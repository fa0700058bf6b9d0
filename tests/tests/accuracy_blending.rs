//! Nodes that blend into their parents: kernel, twin and reference tell one picture, without borders.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

use backend::device::{CpuDevice, Device};
use backend::protocol::FrameState;
use backend::reference::{Integrator, Ray, Reference, StoredField, Tracer};
use backend::store::{Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OctreeShape};
use backend::working_set::{LodRule, is_shown};
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::{Errors, Limits, errors_of, lod_rule};
use lightloom_tests::draw;
use lightloom_tests::presented::{Corner, Presented, picture};
use lightloom_tests::scenes::{self, frame, optics, placed, with_raster};
use lightloom_tests::techniques::{BUMPS_COLOURS, TECHNIQUES};
use lightloom_tests::twin_scene::{TwinScene, view};
use rayon::prelude::*;
use shaders::layout::FULL_WEIGHTS;
use shaders::twin::Real;
use std::sync::Arc;

const PROJECTOR: u32 = 5;
/// Of the reference; a tenth of a code.
const TOLERANCE: f64 = 1e-4;
/// What default quality keeps on every scene.
const KEPT: Limits = Limits::of_255(0.3, 2.0, 4.0);
