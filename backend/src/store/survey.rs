//! What a build learns of its source's values: their range, what was not finite, and how far the store is off.

use crate::volume::{Samples, VolumeError, VolumeReader};

/// Whether a value can be kept: finite, also as the f32 in which levels are computed.
fn can_be_kept(value: f64) -> bool {
    (value as f32).is_finite()
}

/// Replaces what is not finite: NaN by the smallest finite value of the volume, infinities (and what is beyond the
/// range of f32) by the smallest and the largest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cleaner {
    smallest: f64,
    largest: f64,
}

impl Cleaner {
    /// Reads a whole volume to find its finite range.
    pub fn survey(reader: &mut dyn VolumeReader, progress: &dyn Fn(u64)) -> Result<Self, VolumeError> {
        let info = reader.info().clone();
        let mut slab = Samples::new(info.element, info.slab_voxels());
        let mut found = Self { smallest: f64::INFINITY, largest: f64::NEG_INFINITY };
        for z in 0..reader.info().dims.z {
            reader.read_slab(z, &mut slab)?;
            for value in (0..slab.len()).map(|i| info.value(slab.get(i))).filter(|&value| can_be_kept(value))
            {
                found.smallest = found.smallest.min(value);
                found.largest = found.largest.max(value);
            }
            progress(u64::from(z) + 1);
        }
        match found.smallest <= found.largest {
            true => Ok(found),
            false => Err(VolumeError::NoFiniteValue { name: reader.info().name.clone() }),
        }
    }

    /// Cleans values in place; returns how many were not finite.
    pub fn clean(&self, values: &mut [f64]) -> u64 {
        let mut replaced = 0;
        for value in values.iter_mut().filter(|value| !can_be_kept(**value)) {
            *value = if *value > 0.0 { self.largest } else { self.smallest };
            replaced += 1;
        }
        replaced
    }
}

/// Largest and mean square error, in data units.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ErrorTally {
    max: f64,
    squares: f64,
    samples: u64,
}

impl ErrorTally {
    pub fn add(&mut self, error: f64) {
        self.max = self.max.max(error.abs());
        self.squares += error * error;
        self.samples += 1;
    }

    pub fn merge(&mut self, other: Self) {
        self.max = self.max.max(other.max);
        self.squares += other.squares;
        self.samples += other.samples;
    }

    pub fn max(&self) -> f64 {
        self.max
    }

    pub fn rms(&self) -> f64 {
        if self.samples == 0 { 0.0 } else { (self.squares / self.samples as f64).sqrt() }
    }
}

/// What passed from the source into the finest level.
#[derive(Clone, Copy, Debug)]
pub(super) struct SourceTally {
    pub smallest: f64,
    pub largest: f64,
    pub non_finite: u64,
    /// Error of keeping the source's values as f32: none for integers up to 24 bits and for f32.
    pub rounding: ErrorTally,
}

impl SourceTally {
    pub fn new() -> Self {
        Self {
            smallest: f64::INFINITY,
            largest: f64::NEG_INFINITY,
            non_finite: 0,
            rounding: ErrorTally::default(),
        }
    }

    /// Takes a slab of finite values over into the finest level.
    pub fn take(&mut self, source: &[f64], kept: &mut [f32]) {
        for (&value, kept) in source.iter().zip(kept) {
            *kept = value as f32;
            self.smallest = self.smallest.min(value);
            self.largest = self.largest.max(value);
            self.rounding.add(value - f64::from(*kept));
        }
    }
}
