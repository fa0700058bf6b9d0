//! A field of some kind over a box of voxels, at random.

use crate::closure_volume::ClosureVolume;
use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use bricks::store::CodeBits;
use glam::{DVec3, IVec3, UVec3};
use proptest::prelude::*;
use std::sync::Arc;

/// What fills the box; values from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub enum RandomField {
    /// One value.
    Constant(f64),
    /// Sines of so many radians per voxel.
    Bumps {
        /// Radians per voxel along each axis.
        waves: DVec3,
        /// Radians at the origin.
        phase: DVec3,
    },
    /// The same, cut off above and below: constant bricks, and edges where they end.
    Plateaus {
        /// Radians per voxel along each axis.
        waves: DVec3,
        /// Radians at the origin.
        phase: DVec3,
    },
    /// The same in so many stairs: sharp edges.
    Stairs {
        /// Radians per voxel along each axis.
        waves: DVec3,
        /// Radians at the origin.
        phase: DVec3,
        /// How many.
        stairs: u32,
    },
    /// Random values at the corners of cells so many voxels wide, smooth between them.
    Noise {
        /// Voxels along a cell's edge.
        cell: f64,
        /// Which noise.
        seed: u32,
    },
    /// A random value per voxel.
    Grain {
        /// Which grain.
        seed: u32,
    },
    /// One of the formulas.
    Procedural(&'static str),
}

/// A volume.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomVolume {
    /// Voxels along each axis.
    pub dims: UVec3,
    /// What fills them.
    pub field: RandomField,
    /// Bits per stored voxel; a formula's has 16.
    pub bits: CodeBits,
    /// Whether coarse voxels have standard deviations; a formula's have none.
    pub has_deviation: bool,
}

/// Volumes of 1 to 70 voxels along each axis.
pub(super) fn volumes() -> impl Strategy<Value = RandomVolume> {
    let edge = || prop_oneof![6 => 1u32..=70, 1 => Just(1), 1 => Just(28), 1 => Just(29), 1 => Just(56)];
    let bits = prop_oneof![Just(CodeBits::Eight), Just(CodeBits::Sixteen)];
    let has_deviation = prop::bool::ANY;
    ([edge(), edge(), edge()], fields(), bits, has_deviation).prop_map(
        |(dims, field, bits, has_deviation)| RandomVolume {
            dims: UVec3::from(dims),
            field,
            bits,
            has_deviation,
        },
    )
}

fn fields() -> impl Strategy<Value = RandomField> {
    let three = |range: std::ops::Range<f64>| [range.clone(), range.clone(), range].prop_map(DVec3::from);
    let sines = move || (three(0.02..0.4), three(0.0..6.3));
    let names = prop_oneof![Just("shells"), Just("marschner-lobb"), Just("sparse-vessels")];
    prop_oneof![
        1 => (0.0..=1.0).prop_map(RandomField::Constant),
        6 => sines().prop_map(|(waves, phase)| RandomField::Bumps { waves, phase }),
        2 => sines().prop_map(|(waves, phase)| RandomField::Plateaus { waves, phase }),
        1 => (sines(), 2u32..6)
            .prop_map(|((waves, phase), stairs)| RandomField::Stairs { waves, phase, stairs }),
        4 => (3.0..20.0, any::<u32>()).prop_map(|(cell, seed)| RandomField::Noise { cell, seed }),
        1 => any::<u32>().prop_map(|seed| RandomField::Grain { seed }),
        2 => names.prop_map(RandomField::Procedural),
    ]
}

impl RandomVolume {
    /// The data values that map to 0 and 1.
    pub fn domain(&self) -> (f64, f64) {
        (0.0, 1.0)
    }

    /// Whether no value changes much from one voxel to the next.
    pub fn is_smooth(&self) -> bool {
        match self.field {
            RandomField::Constant(_) | RandomField::Bumps { .. } => true,
            RandomField::Noise { cell, .. } => cell >= 6.0,
            // Shells and vessels are a few voxels thick at these sizes, and less.
            RandomField::Plateaus { .. }
            | RandomField::Stairs { .. }
            | RandomField::Grain { .. }
            | RandomField::Procedural(_) => false,
        }
    }

    /// Its bricks.
    pub fn source(&self) -> Arc<dyn BrickSource> {
        match self.field {
            RandomField::Procedural(name) => Arc::new(
                ProceduralVolume::new(name, self.dims, 1e-3)
                    .expect("the name is one of the procedural volumes"),
            ),
            RandomField::Constant(value) => self.closure(move |_| value),
            RandomField::Bumps { waves, phase } => self.closure(move |p| bumps(waves, phase, p)),
            RandomField::Plateaus { waves, phase } => {
                self.closure(move |p| (2.0 * bumps(waves, phase, p) - 0.5).clamp(0.0, 1.0))
            }
            RandomField::Stairs { waves, phase, stairs } => {
                let stairs = f64::from(stairs);
                self.closure(move |p| (bumps(waves, phase, p) * stairs).round() / stairs)
            }
            RandomField::Noise { cell, seed } => self.closure(move |p| noise(p / cell, seed)),
            RandomField::Grain { seed } => self.closure(move |p| grain(p.floor().as_ivec3(), seed)),
        }
    }

    fn closure(&self, value: impl Fn(DVec3) -> f64 + Send + Sync + 'static) -> Arc<dyn BrickSource> {
        let volume = ClosureVolume::new(self.dims, (0.0, 1.0), value);
        Arc::new(volume.with_bits(self.bits).with_deviation(self.has_deviation))
    }
}

fn bumps(waves: DVec3, phase: DVec3, p: DVec3) -> f64 {
    let sines = (waves * p + phase).map(f64::sin);
    (0.5 + 0.5 * (sines.x * sines.y + 0.6 * sines.z) / 1.6).clamp(0.0, 1.0)
}

/// A number from 0 to 1 for a point of the grid.
fn grain(point: IVec3, seed: u32) -> f64 {
    let mut hash = seed;
    for c in point.to_array() {
        hash = (hash ^ c as u32).wrapping_mul(0x9e37_79b1);
        hash = (hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b);
    }
    f64::from(hash ^ hash >> 13) / f64::from(u32::MAX)
}

/// Random values at the grid, interpolated with steps that are smooth.
fn noise(p: DVec3, seed: u32) -> f64 {
    let base = p.floor();
    let t = (p - base).map(|t| t * t * (3.0 - 2.0 * t));
    let corner = |i: i32| grain(base.as_ivec3() + IVec3::new(i & 1, i >> 1 & 1, i >> 2), seed);
    let lerp = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |i: i32| lerp(corner(i), corner(i + 1), t.x);
    lerp(lerp(row(0), row(2), t.y), lerp(row(4), row(6), t.y), t.z)
}
