//! The slabs of a volume, read ahead by a thread of their own: the disk and the decompressor work while others pack.

use super::quantise::range;
use crate::volume::{Sample, Samples, VolumeError, VolumeInfo, VolumeReader, with_samples};
use crossbeam_channel::{Receiver, Sender, bounded};
use std::sync::atomic::{AtomicBool, Ordering};

/// Slabs under way at once: one being read, one waiting, one being taken in.
pub(super) const SLABS_UNDER_WAY: usize = 3;

/// A slab of finite numbers.
pub(super) struct CleanSlab {
    pub stored: Samples,
    /// Voxels that were NaN, infinite or beyond f32, and were replaced.
    pub replaced: u64,
}

/// Hands every slab of a volume, in order, to `take` until it fails; reads ahead meanwhile. False if `stop` ended it.
///
/// NaN becomes the smallest finite value of the volume; infinities, and what is beyond f32, the smallest and the
/// largest. To know these, the first slab that has such a voxel makes the rest of the volume be read twice.
pub(super) fn stream<E: From<VolumeError>>(
    reader: &mut dyn VolumeReader,
    stop: &(dyn Fn() -> bool + Sync),
    mut take: impl FnMut(u32, &CleanSlab) -> Result<(), E>,
) -> Result<bool, E> {
    let info = reader.info().clone();
    let (filled, slabs) = bounded::<Result<CleanSlab, VolumeError>>(SLABS_UNDER_WAY);
    let (emptied, spares) = bounded(SLABS_UNDER_WAY);
    for _ in 0..SLABS_UNDER_WAY {
        let spare = Samples::new(info.element, info.slab_voxels());
        emptied.send(spare).expect("the channel has room for all slabs");
    }
    let is_left = AtomicBool::new(false);
    let should_stop = || is_left.load(Ordering::Relaxed) || stop();
    std::thread::scope(|scope| {
        let (stop, info) = (&should_stop, &info);
        let ahead = ReadAhead { reader, info, stop, range: None, has_huge_values: false, cleaner: None };
        scope.spawn(move || ahead.run(&spares, &filled));
        let mut take_all = || {
            for z in 0..info.dims.z {
                // A thread that ended without an error was asked to stop.
                let Ok(slab) = slabs.recv() else { return Ok(false) };
                let slab = slab?;
                take(z, &slab)?;
                // The thread that read the last slab is gone.
                let _ = emptied.send(slab.stored);
            }
            Ok(true)
        };
        let taken = take_all();
        is_left.store(true, Ordering::Relaxed);
        // The thread finds the channels closed where it waits for them.
        drop((slabs, emptied));
        taken
    })
}

/// The reading thread's part.
struct ReadAhead<'a> {
    reader: &'a mut dyn VolumeReader,
    info: &'a VolumeInfo,
    stop: &'a (dyn Fn() -> bool + Sync),
    /// Stored numbers of the smallest and the largest finite value so far, where there may be others.
    range: Option<(f64, f64)>,
    /// Whether there was a finite value beyond f32.
    has_huge_values: bool,
    cleaner: Option<Cleaner>,
}

impl ReadAhead<'_> {
    fn run(mut self, spares: &Receiver<Samples>, filled: &Sender<Result<CleanSlab, VolumeError>>) {
        for z in 0..self.info.dims.z {
            let Ok(mut stored) = spares.recv() else { return };
            let slab = match self.read(z, &mut stored) {
                Ok(None) => return,
                Ok(Some(replaced)) => Ok(CleanSlab { stored, replaced }),
                Err(error) => Err(error),
            };
            let is_last = slab.is_err();
            if filled.send(slab).is_err() || is_last {
                return;
            }
        }
    }

    /// Reads a slab and cleans it; returns how many voxels were replaced, or None if asked to stop.
    fn read(&mut self, z: u32, slab: &mut Samples) -> Result<Option<u64>, VolumeError> {
        if (self.stop)() {
            return Ok(None);
        }
        self.reader.read_slab(z, slab)?;
        if self.info.is_all_finite() {
            return Ok(Some(0));
        }
        if is_clean(slab, self.info) {
            self.look(slab);
            return Ok(Some(0));
        }
        if self.cleaner.is_none() {
            self.cleaner = self.survey(z, slab)?;
            // Other slabs were read on the way.
            self.reader.read_slab(z, slab)?;
        }
        Ok(self.cleaner.map(|cleaner| cleaner.clean(slab, self.info)))
    }

    /// Takes the finite numbers of a slab into the range.
    fn look(&mut self, slab: &Samples) {
        if self.cleaner.is_some() {
            return;
        }
        let numbers = (0..slab.len()).map(|i| slab.get(i)).filter(|&v| can_be_kept(self.info.value(v)));
        let (low, high) = match slab {
            Samples::F32(values) if self.info.is_unscaled() && is_clean(slab, self.info) => {
                let (low, high) = range(values);
                (f64::from(low), f64::from(high))
            }
            _ => numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v))),
        };
        if low > high && !self.has_huge_values {
            self.has_huge_values = (0..slab.len()).any(|i| self.info.value(slab.get(i)).is_finite());
        }
        let (lowest, highest) = self.range.unwrap_or((low, high));
        self.range = (low <= high).then(|| (lowest.min(low), highest.max(high))).or(self.range);
    }

    /// Reads the rest of the volume for its finite range; None if asked to stop.
    fn survey(&mut self, z: u32, slab: &mut Samples) -> Result<Option<Cleaner>, VolumeError> {
        self.look(slab);
        for z in z + 1..self.info.dims.z {
            if (self.stop)() {
                return Ok(None);
            }
            self.reader.read_slab(z, slab)?;
            self.look(slab);
        }
        let nothing = || {
            let name = self.info.name.clone();
            match self.has_huge_values {
                true => VolumeError::BeyondSinglePrecision { name },
                false => VolumeError::NoFiniteValue { name },
            }
        };
        let (low, high) = self.range.ok_or_else(nothing)?;
        // A negative slope turns the order of values around.
        let [smallest, largest] = if self.info.slope > 0.0 { [low, high] } else { [high, low] };
        Ok(Some(Cleaner { smallest, largest }))
    }
}

fn is_clean(slab: &Samples, info: &VolumeInfo) -> bool {
    match slab {
        // A finite number times zero is zero; anything else gives NaN.
        Samples::F32(values) if info.is_unscaled() => {
            values.chunks(1024).all(|part| part.iter().fold(true, |all, &v| all & (v * 0.0 == 0.0)))
        }
        _ => with_samples!(slab, |values| values.iter().all(|&v| can_be_kept(info.value(v.to_f64())))),
    }
}

/// Whether a value can be kept: finite, also as the f32 in which levels are computed.
fn can_be_kept(value: f64) -> bool {
    (value as f32).is_finite()
}

/// The stored numbers of the smallest and the largest finite value.
#[derive(Clone, Copy, Debug)]
struct Cleaner {
    smallest: f64,
    largest: f64,
}

impl Cleaner {
    /// Cleans numbers in place; returns how many were infinite or NaN.
    fn clean(&self, slab: &mut Samples, info: &VolumeInfo) -> u64 {
        let mut replaced = 0;
        for i in 0..slab.len() {
            let value = info.value(slab.get(i));
            if !can_be_kept(value) {
                slab.set(i, if value > 0.0 { self.largest } else { self.smallest });
                replaced += 1;
            }
        }
        replaced
    }
}
