//! The slabs of a volume, read ahead by a thread of their own: the disk and the decompressor work while others pack.

use crate::volume::{Sample, Samples, VolumeError, VolumeInfo, VolumeReader, with_samples};
use crossbeam_channel::{Receiver, Sender, bounded};

/// Slabs under way at once: one being read, one waiting, one being taken in.
pub(super) const SLABS_UNDER_WAY: usize = 3;

/// A slab without anything that is not finite.
pub(super) struct CleanSlab {
    pub stored: Samples,
    /// Voxels that were NaN, infinite or beyond f32, and were replaced.
    pub replaced: u64,
}

/// Hands every slab of a volume, in order, to `take` until it fails; reads ahead meanwhile.
///
/// NaN becomes the smallest finite value of the volume; infinities, and what is beyond f32, the smallest and the
/// largest. To know these the volume is read a second time, from the first slab on that has such a voxel; `survey` is
/// told the slabs that are done of that.
pub(super) fn stream<E: From<VolumeError>>(
    reader: &mut dyn VolumeReader,
    survey: &(dyn Fn(u32) + Sync),
    mut take: impl FnMut(u32, &CleanSlab) -> Result<(), E>,
) -> Result<(), E> {
    let info = reader.info().clone();
    let (filled, slabs) = bounded::<Result<CleanSlab, VolumeError>>(SLABS_UNDER_WAY);
    let (emptied, spares) = bounded(SLABS_UNDER_WAY);
    for _ in 0..SLABS_UNDER_WAY {
        let spare = Samples::new(info.element, info.slab_voxels());
        emptied.send(spare).expect("the channel has room for all slabs");
    }
    std::thread::scope(|scope| {
        scope.spawn(move || read_ahead(reader, &spares, &filled, survey));
        // Owned here, so that the thread finds the channel closed where this ends early.
        let slabs = slabs;
        let emptied = emptied;
        for z in 0..info.dims.z {
            let slab = slabs.recv().expect("the reading thread sends every slab, or an error")?;
            take(z, &slab)?;
            // The thread that read the last slab is gone.
            let _ = emptied.send(slab.stored);
        }
        Ok(())
    })
}

fn read_ahead(
    reader: &mut dyn VolumeReader,
    spares: &Receiver<Samples>,
    filled: &Sender<Result<CleanSlab, VolumeError>>,
    survey: &(dyn Fn(u32) + Sync),
) {
    let mut cleaner = None;
    for z in 0..reader.info().dims.z {
        let Ok(mut stored) = spares.recv() else { return };
        let slab = reader
            .read_slab(z, &mut stored)
            .and_then(|()| clean(reader, &mut stored, &mut cleaner, survey))
            .and_then(|replaced| match replaced {
                // Another slab was read on the way.
                None => reader
                    .read_slab(z, &mut stored)
                    .and_then(|()| clean(reader, &mut stored, &mut cleaner, survey)),
                some => Ok(some),
            })
            .map(|replaced| CleanSlab { stored, replaced: replaced.unwrap_or(0) });
        let is_last = slab.is_err();
        if filled.send(slab).is_err() || is_last {
            return;
        }
    }
}

/// Cleans a slab; None where the volume had to be surveyed first, which spends the slab.
fn clean(
    reader: &mut dyn VolumeReader,
    slab: &mut Samples,
    cleaner: &mut Option<Cleaner>,
    survey: &(dyn Fn(u32) + Sync),
) -> Result<Option<u64>, VolumeError> {
    let info = reader.info().clone();
    if info.is_all_finite() || is_clean(slab, &info) {
        return Ok(Some(0));
    }
    match cleaner {
        Some(cleaner) => Ok(Some(cleaner.clean(slab, &info))),
        None => {
            *cleaner = Some(Cleaner::survey(reader, slab, survey)?);
            Ok(None)
        }
    }
}

fn is_clean(slab: &Samples, info: &VolumeInfo) -> bool {
    match slab {
        // A number times zero is zero, and NaN for what is not finite.
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
    /// Reads a whole volume to find its finite range.
    fn survey(
        reader: &mut dyn VolumeReader,
        slab: &mut Samples,
        progress: &(dyn Fn(u32) + Sync),
    ) -> Result<Self, VolumeError> {
        let info = reader.info().clone();
        let mut range: Option<(f64, f64)> = None;
        for z in 0..info.dims.z {
            reader.read_slab(z, slab)?;
            let stored = (0..slab.len()).map(|i| slab.get(i)).filter(|&v| can_be_kept(info.value(v)));
            for number in stored {
                let (low, high) = range.unwrap_or((number, number));
                range = Some((low.min(number), high.max(number)));
            }
            progress(z + 1);
        }
        let (low, high) = range.ok_or_else(|| VolumeError::NoFiniteValue { name: info.name.clone() })?;
        // A negative slope turns the order of values around.
        let [smallest, largest] = if info.slope > 0.0 { [low, high] } else { [high, low] };
        Ok(Self { smallest, largest })
    }

    /// Cleans numbers in place; returns how many were not finite.
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
