//! Scenes for the tests: a brick source from a closure, and frames around an optical model.

use super::{Integrator, Tracer};
use bricks::LodRule;
use bricks::{
    BRICK_EDGE, Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OVERLAP, OWN_EDGE, OctreeShape,
};
use glam::{DAffine3, DVec3, UVec3};
use optics::{Curve, ExtinctionUnit, Light, Mimda, MimdaForm, Optics, Quality};
use protocol::{FrameState, Pace};
use std::sync::Arc;

/// Edge of a voxel in the tests' frames, metres.
pub const VOXEL_M: f64 = 0.01;

type Formula = Box<dyn Fn(DVec3) -> f64 + Send + Sync>;

/// A store that computes its samples, at 16 bits, from a formula of the volume frame.
pub struct FormulaSource {
    shape: OctreeShape,
    formula: Formula,
    range: (f64, f64),
}

impl FormulaSource {
    /// `dims` voxels of a formula whose values all lie in `range`.
    pub fn shared(
        dims: UVec3,
        range: (f64, f64),
        formula: impl Fn(DVec3) -> f64 + Send + Sync + 'static,
    ) -> Arc<Self> {
        Arc::new(Self { shape: OctreeShape::new(dims), formula: Box::new(formula), range })
    }

    fn samples(&self, node: NodeKey) -> Vec<f64> {
        let edge = f64::from(1u32 << self.shape.level(node.depth));
        let last = self.shape.level_dims(node.depth).as_ivec3() - 1;
        let first = node.cell.as_ivec3() * OWN_EDGE as i32 - OVERLAP as i32;
        let n = BRICK_EDGE as i32;
        let mut samples = Vec::new();
        for k in 0..n {
            for j in 0..n {
                for i in 0..n {
                    let voxel = (first + glam::IVec3::new(i, j, k)).clamp(glam::IVec3::ZERO, last);
                    samples.push((self.formula)((voxel.as_dvec3() + 0.5) * edge));
                }
            }
        }
        samples
    }
}

impl BrickSource for FormulaSource {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn frame(&self) -> bricks::volume::VolumeFrame {
        bricks::volume::VolumeFrame::of_voxels(DVec3::splat(VOXEL_M))
    }

    fn value_range(&self) -> (f64, f64) {
        self.range
    }

    fn summary(&self, _node: NodeKey) -> NodeSummary {
        NodeSummary { min: self.range.0 as f32, max: self.range.1 as f32 }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        let samples = self.samples(node);
        let low = samples.iter().copied().fold(f64::INFINITY, f64::min) as f32;
        let high = samples.iter().copied().fold(f64::NEG_INFINITY, f64::max) as f32;
        let step = (high - low) / 65535.0;
        let code =
            |v: f64| if step > 0.0 { ((v - f64::from(low)) / f64::from(step)).round() as u16 } else { 0 };
        Ok(Brick::new(Codes::U16(samples.into_iter().map(code).collect()), low, step))
    }
}

/// An optical model over the domain [0, 1], per voxel.
pub fn optics(extinction: Curve<f64>, colour: Curve<DVec3>) -> Optics {
    Optics {
        domain: (0.0, 1.0),
        extinction,
        extinction_unit: ExtinctionUnit::PerVoxel,
        colour,
        mimda: None,
        refraction: None,
        materials: None,
        enhancers: Vec::new(),
    }
}

/// The same with importance.
pub fn with_importance(optics: Optics, importance: Curve<f64>, gamma: f64, form: MimdaForm) -> Optics {
    Optics { mimda: Some(Mimda { importance, gamma, form }), ..optics }
}

/// A frame that puts volume (0, 0, 0) at the display's origin, axes aligned.
pub fn frame(optics: Optics, light: Option<Light>) -> FrameState {
    FrameState {
        index: 0,
        time_s: 0.0,
        observer_in_display: DVec3::new(0.0, 0.0, 3.0),
        eta: 1.0,
        display_from_volume: DAffine3::from_scale(DVec3::splat(VOXEL_M)),
        optics,
        light,
        quality: Quality::default(),
        tool: None,
        pace: Pace::Complete,
        debug: None,
    }
}

/// The tracer of that frame.
pub fn tracer(optics: Optics, tolerance: f64) -> Tracer {
    Tracer::new(&frame(optics, None), Integrator { tolerance, ..Integrator::default() }).unwrap()
}

/// The rule that asks for the finest level everywhere.
pub fn finest() -> LodRule {
    LodRule {
        display_from_volume: DAffine3::from_scale(DVec3::splat(VOXEL_M)),
        pixel_size_m: 0.0015,
        angular_accuracy: 0.014,
        lod_scale: 0.0,
    }
}

/// A smooth busy function with values in [0, 1].
pub fn noise(p: DVec3) -> f64 {
    let wave = |k: DVec3, phase: f64| (k.dot(p) + phase).sin();
    let sum = wave(DVec3::new(0.9, 0.4, -0.6), 0.3)
        + wave(DVec3::new(-0.5, 1.1, 0.7), 1.9)
        + wave(DVec3::new(0.31, -0.45, 0.83), 4.1);
    0.5 + sum / 6.0
}
