//! From a node's samples to the bytes of its brick, and how far these are from the source.

use super::bytes::checksum;
use super::entry::{Checksums, Entry, Extent};
use super::level::{Level, Spread};
use super::quantise::{nearest, quantise_within, range};
use super::tally::ErrorTally;
use super::{CodeBits, Codec, Emptiness};
use crate::{BRICK_EDGE, Brick, CellRanges, Codes, Deviation, NodeKey, OVERLAP, OWN_EDGE};
use glam::UVec3;
use std::borrow::Cow;
use std::ops::{Add, Mul, Sub};

/// Within these limits, squares of errors are far from the ends of f32's range.
const SHORT_STEPS: std::ops::RangeInclusive<f32> = 1e-12..=1e12;

/// How to pack.
pub(super) struct PackRules<'a> {
    pub bits: CodeBits,
    pub codec: Codec,
    pub emptiness: &'a Emptiness,
    /// Voxels of the source.
    pub source: UVec3,
}

/// A brick ready to be written; `entry` lacks the offset and the children.
pub(super) struct PackedBrick {
    pub node: NodeKey,
    pub entry: Entry,
    pub bytes: Vec<u8>,
    /// Of the finest level against the source; of a coarse one, squares against its own means.
    pub errors: ErrorTally,
    /// Smallest and largest of its samples.
    pub range: (f32, f32),
    /// Whether it was left out although its samples differ.
    pub is_emptied: bool,
}

/// Space for the samples of a brick, reused for the next.
#[derive(Default)]
pub(super) struct Scratch {
    samples: Vec<f32>,
    bound: Vec<f32>,
}

/// Quantises and packs the brick of a node of a complete layer.
pub(super) fn pack(level: &Level, node: NodeKey, rules: &PackRules, scratch: &mut Scratch) -> PackedBrick {
    if let Some(value) = level.uniform_brick(node) {
        return constant(node, value, (value, value), ErrorTally::default());
    }
    let Scratch { samples, bound } = scratch;
    level.samples(node, &level.means, |value| value, samples);
    let (low, high) = range(samples);
    if low < high && rules.emptiness.applies(low, high) {
        let codes = vec![0u8; samples.len()];
        let errors = errors(level, node, rules, samples, bound, &Brick::new(Codes::U8(codes), low, 0.0));
        return constant(node, low, (low, high), errors);
    }
    let brick = quantise_within(samples, (low, high), rules.bits);
    let errors = errors(level, node, rules, samples, bound, &brick);
    let deviation = deviation(level, node, samples);
    encode(node, &brick, (low, high), deviation.as_ref(), errors, rules)
}

/// A brick that takes no bytes, of samples in a range: left out where they differ.
fn constant(node: NodeKey, value: f32, range: (f32, f32), errors: ErrorTally) -> PackedBrick {
    let entry = Entry { min: value, max: value, low: value, ..Entry::default() };
    PackedBrick { node, entry, bytes: Vec::new(), errors, range, is_emptied: range.0 < range.1 }
}

fn encode(
    node: NodeKey,
    brick: &Brick,
    range: (f32, f32),
    deviation: Option<&Deviation>,
    errors: ErrorTally,
    rules: &PackRules,
) -> PackedBrick {
    let (mut bytes, mut extent) = (Vec::new(), Extent::default());
    let put = |plain: &[u8], bytes: &mut Vec<u8>| rules.codec.pack_into(plain, bytes) as u32;
    if brick.step > 0.0 {
        extent.cells = put(&CellRanges::of(&brick.codes).to_bytes(rules.bits), &mut bytes);
        extent.codes = put(&plain(&brick.codes), &mut bytes);
    }
    if let Some(deviation) = deviation {
        extent.deviation = put(&deviation.codes, &mut bytes);
    }
    let (cells, voxels) = bytes.split_at(extent.cells as usize);
    extent.checksums = Some(Checksums { cells: checksum(cells), voxels: checksum(voxels) });
    let deviation_step = deviation.map_or(0.0, |deviation| deviation.step);
    let Brick { low, step, .. } = *brick;
    let entry = Entry { min: low, max: range.1, low, step, deviation_step, extent, ..Entry::default() };
    PackedBrick { node, entry, bytes, errors, range, is_emptied: false }
}

/// The bytes of codes, little-endian.
fn plain(codes: &Codes) -> Cow<'_, [u8]> {
    match codes {
        Codes::U8(codes) => Cow::Borrowed(codes),
        Codes::U16(codes) if cfg!(target_endian = "little") => Cow::Borrowed(bytemuck::cast_slice(codes)),
        Codes::U16(codes) => codes.iter().flat_map(|code| code.to_le_bytes()).collect(),
    }
}

/// The standard deviations of a coarse node, instead of its samples; None if they are not kept or all zero.
fn deviation(level: &Level, node: NodeKey, samples: &mut Vec<f32>) -> Option<Deviation> {
    let deviation = level.spread.as_ref()?.deviation.as_ref()?;
    level.samples(node, deviation, |_| 0.0, samples);
    let largest = range(samples).1;
    if largest <= 0.0 {
        return None;
    }
    // The least f32 is its own 255th part.
    let step = (largest / 255.0).max(f32::from_bits(1));
    let codes = samples.iter().map(|deviation| nearest(deviation / step) as u8).collect();
    Some(Deviation { codes, step })
}

/// Errors of a node's own voxels: of the finest level against the source; of a coarse one, squares against its own
/// means (those of the means against the source are known from making them) and the largest against the source.
fn errors(
    level: &Level,
    node: NodeKey,
    rules: &PackRules,
    samples: &[f32],
    bound: &mut Vec<f32>,
    brick: &Brick,
) -> ErrorTally {
    let own = Own::of(level, node, rules.source);
    let mut tally = own.tally(brick, samples);
    if let Some(Spread { low, high, .. }) = &level.spread {
        tally.max = 0.0;
        for ring in [low, high] {
            level.samples(node, ring, |value| value, bound);
            tally.max = tally.max.max(own.tally(brick, bound).max);
        }
    }
    tally
}

/// A node's own voxels, and how many voxels of the source each stands for along every axis.
struct Own {
    edges: [usize; 3],
    source_voxels: [[f32; OWN_EDGE]; 3],
}

impl Own {
    fn of(level: &Level, node: NodeKey, source: UVec3) -> Self {
        let edge =
            |axis: usize| (level.dims[axis] as usize - node.cell[axis] as usize * OWN_EDGE).min(OWN_EDGE);
        let source_voxels = [0, 1, 2].map(|axis| level.source_voxels(node.cell[axis], source[axis]));
        Self { edges: [0, 1, 2].map(edge), source_voxels }
    }

    /// Differences of a brick's values to some samples.
    fn tally(&self, brick: &Brick, samples: &[f32]) -> ErrorTally {
        let is_short = SHORT_STEPS.contains(&brick.step);
        match &brick.codes {
            Codes::U8(codes) if is_short => self.rows::<u8, f32>(codes, brick, samples),
            Codes::U8(codes) => self.rows::<u8, f64>(codes, brick, samples),
            // Whole numbers and their differences are exact in f32.
            Codes::U16(codes) if brick.step == 1.0 => self.rows::<u16, f32>(codes, brick, samples),
            Codes::U16(codes) => self.rows::<u16, f64>(codes, brick, samples),
        }
    }

    fn rows<C, T>(&self, codes: &[C], brick: &Brick, samples: &[f32]) -> ErrorTally
    where
        C: Copy,
        T: Copy + From<C> + From<f32> + Into<f64> + PartialOrd,
        T: Add<Output = T> + Sub<Output = T> + Mul<Output = T>,
    {
        let (low, step) = (T::from(brick.low), T::from(brick.step));
        let [xs, ys, zs] = &self.source_voxels;
        let zero = T::from(0.0f32);
        let (mut squares, mut largest) = (0.0, [zero; OWN_EDGE]);
        for (k, &z) in zs.iter().enumerate().take(self.edges[2]) {
            // Column by column, which the compiler turns into vectors as it may not do with sums along a row.
            let mut sums = [zero; OWN_EDGE];
            for (j, &y) in ys.iter().enumerate().take(self.edges[1]) {
                let start = ((k + OVERLAP) * BRICK_EDGE + j + OVERLAP) * BRICK_EDGE + OVERLAP;
                let (codes, samples) = (&codes[start..start + OWN_EDGE], &samples[start..start + OWN_EDGE]);
                let weight = T::from(y);
                for i in 0..OWN_EDGE {
                    let difference = T::from(codes[i]) * step - (T::from(samples[i]) - low);
                    let square = difference * difference;
                    sums[i] = sums[i] + square * weight;
                    largest[i] = if square > largest[i] { square } else { largest[i] };
                }
            }
            let weighted = sums.iter().zip(xs).map(|(&sum, &x)| sum.into() * f64::from(x));
            squares += weighted.sum::<f64>() * f64::from(z);
        }
        let largest = largest[..self.edges[0]].iter().fold(0.0f64, |most, &square| most.max(square.into()));
        ErrorTally { max: largest.sqrt(), squares }
    }
}
