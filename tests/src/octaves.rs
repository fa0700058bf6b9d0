//! A dense volume with as much to see at every level of detail: waves of all octaves, from half the volume to a few voxels.

use crate::random::Random;
use crate::scenes;
use bricks::volume::VolumeFrame;
use bricks::{
    BRICK_EDGE, BRICK_VOXELS, Brick, BrickError, BrickSource, Codes, NodeKey, NodeSummary, OVERLAP, OWN_EDGE,
    OctreeShape,
};
use glam::{DVec3, IVec3, UVec3};
use optics::Optics;
use std::f64::consts::TAU;

/// Waves of each octave.
const PER_OCTAVE: usize = 3;
/// Voxels of the shortest wave, at least.
const SHORTEST: f64 = 4.0;
/// The amplitude of an octave, of the one before.
const NEXT_AMPLITUDE: f64 = 0.8;

/// A product of one sine along each axis.
struct Wave {
    amplitude: f64,
    /// Radians per finest voxel.
    frequency: DVec3,
    phase: DVec3,
}

/// The volume: 1/2 and the sum of its waves. Voxels of every level are the means of what they stand for, which is known
/// here: the mean of sin(ωx) over a width e is sin(ωx) · sin(ωe/2) / (ωe/2).
pub struct Octaves {
    shape: OctreeShape,
    waves: Vec<Wave>,
}

impl Octaves {
    /// `edge` voxels along each axis.
    pub fn new(edge: u32, seed: u64) -> Self {
        let mut random = Random(seed);
        let mut share = || random.below(1 << 24) as f64 / f64::from(1 << 24);
        let mut waves = Vec::new();
        let (mut length, mut amplitude) = (0.5 * f64::from(edge), 1.0);
        while length >= SHORTEST {
            for _ in 0..PER_OCTAVE {
                let frequency =
                    DVec3::from_array(std::array::from_fn(|_| TAU / length * (0.6 + 0.4 * share())));
                let phase = DVec3::from_array(std::array::from_fn(|_| TAU * share()));
                waves.push(Wave { amplitude, frequency, phase });
            }
            (length, amplitude) = (0.5 * length, NEXT_AMPLITUDE * amplitude);
        }
        let sum: f64 = waves.iter().map(|wave| wave.amplitude).sum();
        waves.iter_mut().for_each(|wave| wave.amplitude *= 0.5 / sum);
        Self { shape: OctreeShape::new(UVec3::splat(edge)), waves }
    }
}

/// The waves of a volume of `edge` voxels as a cloud: what is above the mean shows, and hides what lies behind within a
/// twentieth of the volume.
pub fn cloudy(edge: u32) -> Optics {
    let most = 200.0 / f64::from(edge);
    scenes::optics(
        (0.0, 1.0),
        &vec![(0.5, 0.0), (0.6, most), (1.0, most)],
        &vec![(0.48, [0.9, 0.35, 0.1]), (0.54, [0.1, 0.6, 0.9]), (0.62, [1.0, 1.0, 0.9])],
    )
}

impl Wave {
    /// The mean over voxels of an edge around some places along one axis.
    fn along(&self, axis: usize, places: &[f64; BRICK_EDGE], edge: f64) -> [f64; BRICK_EDGE] {
        let half = 0.5 * edge * self.frequency[axis];
        places.map(|x| (self.frequency[axis] * x + self.phase[axis]).sin() * half.sin() / half)
    }
}

impl BrickSource for Octaves {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn frame(&self) -> VolumeFrame {
        VolumeFrame::of_voxels(DVec3::splat(1e-3))
    }

    fn value_range(&self) -> (f64, f64) {
        (0.0, 1.0)
    }

    fn summary(&self, _: NodeKey) -> NodeSummary {
        NodeSummary { min: 0.0, max: 1.0 }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        let last = self.shape.level_dims(node.depth).as_ivec3() - 1;
        let edge = f64::from(1u32 << self.shape.level(node.depth));
        let first = node.cell.as_ivec3() * OWN_EDGE as i32 - OVERLAP as i32;
        let place = |axis: usize, i: usize| {
            let voxel = (first + IVec3::splat(i as i32))[axis].clamp(0, last[axis]);
            (f64::from(voxel) + 0.5) * edge
        };
        let places: [[f64; BRICK_EDGE]; 3] =
            std::array::from_fn(|axis| std::array::from_fn(|i| place(axis, i)));
        let mut values = vec![0.5; BRICK_VOXELS];
        for wave in &self.waves {
            let [x, y, z] = [0, 1, 2].map(|axis| wave.along(axis, &places[axis], edge));
            for (row, values) in values.chunks_exact_mut(BRICK_EDGE).enumerate() {
                let yz = wave.amplitude * y[row % BRICK_EDGE] * z[row / BRICK_EDGE];
                values.iter_mut().zip(&x).for_each(|(value, x)| *value += yz * x);
            }
        }
        let codes = values.iter().map(|value| (value * 65535.0).round() as u16).collect();
        Ok(Brick::new(Codes::U16(codes), 0.0, 1.0 / 65535.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three octaves show in 64 voxels: each level's bricks hold the means of the level below, and vary as much.
    #[test]
    fn coarse_voxels_are_means_of_finer_ones() {
        let volume = Octaves::new(64, 1);
        let codes = |node: NodeKey| match volume.brick(node).expect("it has no holes").codes {
            Codes::U16(codes) => codes,
            Codes::U8(_) => panic!("it has 16 bits"),
        };
        let at = |codes: &[u16], p: UVec3| {
            let p = p + OVERLAP as u32;
            f64::from(codes[((p.z * BRICK_EDGE as u32 + p.y) * BRICK_EDGE as u32 + p.x) as usize])
        };
        let finest = volume.shape.finest_depth();
        let child = NodeKey::ROOT.child(0);
        assert!(finest >= 2, "{finest}");
        let (coarse, fine) = (codes(NodeKey::ROOT), codes(child));
        let mut spread = 0.0_f64;
        for p in [UVec3::new(3, 5, 7), UVec3::new(11, 2, 9), UVec3::new(0, 13, 6)] {
            let corner = |i: u32| UVec3::new(i & 1, i >> 1 & 1, i >> 2);
            let mean = (0..8).map(|i| at(&fine, 2 * p + corner(i))).sum::<f64>() / 8.0;
            assert!((at(&coarse, p) - mean).abs() <= 1.0, "{p}: {} of {mean}", at(&coarse, p));
            spread =
                spread.max((0..8).map(|i| (at(&fine, 2 * p + corner(i)) - mean).abs()).fold(0.0, f64::max));
        }
        assert!(spread > 500.0, "finer voxels differ by {spread} codes");
    }
}
