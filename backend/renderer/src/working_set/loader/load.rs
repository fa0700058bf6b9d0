//! One brick, read and unpacked as a device's cache holds it.

use bricks::{BRICK_VOXELS, Brick, BrickError, BrickSource, CellRanges, Codes, NodeKey};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A brick as a device's cache holds it.
#[derive(Clone, Debug)]
pub struct LoadedBrick {
    /// 32³ samples; 65535 stands for 1. 8-bit codes are spread over the same range without loss.
    pub samples: Vec<u16>,
    /// Range of the samples around each of the 8³ cells.
    pub cells: CellRanges,
    /// Standard deviations of what the samples stand for, where the source keeps them.
    pub deviation: Option<LoadedDeviation>,
    /// Data value of sample 0.
    pub low: f64,
    /// Data value of sample 65535, less `low`.
    pub span: f64,
    /// Bytes of the codes as the store held them, decoded.
    pub bytes: u64,
}

impl LoadedBrick {
    /// One of which nothing but its size matters.
    pub fn without_samples(bytes: u64) -> Self {
        let cells = CellRanges::uniform(0);
        Self { samples: Vec::new(), cells, deviation: None, low: 0.0, span: 0.0, bytes }
    }
}

/// Standard deviations of a brick's samples.
#[derive(Clone, Debug)]
pub struct LoadedDeviation {
    /// 32³ codes; 255 stands for `largest`.
    pub codes: Vec<u8>,
    /// Range of the codes around each of the 8³ cells.
    pub cells: CellRanges,
    /// Data units.
    pub largest: f64,
}

/// A node, and its brick or why it cannot be read.
pub type Fetched = (NodeKey, Result<LoadedBrick, BrickError>);

/// Bytes of a brick's samples: all bricks have the same.
pub const SAMPLE_BYTES: u64 = 2 * BRICK_VOXELS as u64;

/// Reads and unpacks a brick. A panic of its reader becomes an error, so that nothing waits for this brick for ever.
///
/// # Errors
/// It cannot be read.
pub(super) fn load(source: &dyn BrickSource, key: NodeKey) -> Result<LoadedBrick, BrickError> {
    let read = || {
        // Who splits the node asks for its children's bounds, and must not wait for the disk then.
        let children = (0..8).map(|octant| key.child(octant));
        children.filter(|&child| source.shape().contains(child)).for_each(|child| _ = source.summary(child));
        source.brick(key).and_then(|brick| unpack(brick, key))
    };
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        Err(BrickError::damaged(format!("reading brick {key:?} failed inside the program")))
    })
}

fn unpack(brick: Brick, key: NodeKey) -> Result<LoadedBrick, BrickError> {
    let count = match &brick.codes {
        Codes::U8(codes) => codes.len(),
        Codes::U16(codes) => codes.len(),
    };
    if count != BRICK_VOXELS {
        let sentence = format!("brick {key:?} has {count} samples instead of {BRICK_VOXELS}");
        return Err(BrickError::damaged(sentence));
    }
    let largest = brick.codes.largest();
    let factor = u16::MAX / largest;
    let cells = brick.cells.unwrap_or_else(|| CellRanges::of(&brick.codes)).scaled(factor);
    let (samples, bytes) = match brick.codes {
        Codes::U8(codes) => {
            (codes.into_iter().map(|code| u16::from(code) * factor).collect(), BRICK_VOXELS as u64)
        }
        Codes::U16(codes) => (codes, SAMPLE_BYTES),
    };
    let span = f64::from(brick.step) * f64::from(largest);
    let lengths = brick.deviation.as_ref().map(|deviation| deviation.codes.len());
    if let Some(count) = lengths.filter(|&count| count != BRICK_VOXELS) {
        let sentence = format!("brick {key:?} has {count} standard deviations instead of {BRICK_VOXELS}");
        return Err(BrickError::damaged(sentence));
    }
    let deviation =
        brick.deviation.filter(|deviation| deviation.step > 0.0).map(|deviation| LoadedDeviation {
            cells: CellRanges::of_samples(&deviation.codes),
            largest: f64::from(u8::MAX) * f64::from(deviation.step),
            codes: deviation.codes,
        });
    Ok(LoadedBrick { samples, cells, deviation, low: f64::from(brick.low), span, bytes })
}
