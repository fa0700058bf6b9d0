//! A level of an image, read as a volume: a layer of chunks is decoded once and hands out its planes.

use super::super::Selection;
use super::array::LevelArray;
use super::axes::Axes;
use super::image::{Image, Level};
use super::layer::{Grouping, Planes};
use bricks::volume::{Element, MAX_EDGE_VOXELS, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
use glam::{DVec3, UVec3};
use half::f16;
use rayon::prelude::*;
use std::ops::Range;
use std::path::Path;

/// Largest plane, unless the user allows more memory: whoever reads has one in memory.
const MOST_PLANE_BYTES: u64 = 2 << 30;

/// An open volume.
pub(super) struct ZarrVolume {
    info: VolumeInfo,
    array: LevelArray,
    axes: Axes,
    /// Which index of each dimension is meant, where it is not x, y or z.
    picks: Vec<u64>,
    grouping: Grouping,
    /// Chunks decoded before they are put into the planes.
    units_at_once: u64,
    planes: Planes,
}

impl ZarrVolume {
    /// Opens the level that is selected; `path` is what the user named.
    pub fn open(path: &Path, image: &Image, selection: &Selection) -> Result<Self, VolumeError> {
        let level = selected_level(image, selection)?;
        let folder = image.level_folder(level);
        let array = LevelArray::open(&folder, selection.memory_bytes)?;
        let axes = match &image.axes {
            Some(axes) => axes.clone(),
            None => Axes::of_unnamed(&folder, array.shape.len())?,
        };
        if axes.count != array.shape.len() {
            let what = format!("it has {} dimensions, and its image {} axes", array.shape.len(), axes.count);
            return Err(VolumeError::header(&folder, what));
        }
        let dims = dims(&folder, &array, &axes)?;
        let picks = picks(&folder, image, &array, &axes, selection)?;
        let frame = frame(&folder, level, &axes, selection)?;
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let info = VolumeInfo::unscaled(name, dims, frame, array.element);
        Self::plan(&folder, info, array, axes, picks, selection.memory_bytes)
    }

    /// Shares the memory: half for the planes, half for chunks being decoded.
    fn plan(
        folder: &Path,
        info: VolumeInfo,
        array: LevelArray,
        axes: Axes,
        picks: Vec<u64>,
        memory_bytes: u64,
    ) -> Result<Self, VolumeError> {
        let plane_bytes = info.slab_voxels() as u64 * array.voxel_bytes() as u64;
        if plane_bytes > MOST_PLANE_BYTES.max(memory_bytes) {
            let what = format!("one of its planes takes {plane_bytes} bytes: choose a coarser level");
            return Err(VolumeError::unsupported(folder, what));
        }
        let unit_z = axes.z.map_or(1, |z| array.unit[z]);
        let side = |axis: usize| array.shape[axis].div_ceil(array.unit[axis]);
        let units = side(axes.x) * side(axes.y);
        let grouping = Grouping::new(info.dims.z.into(), unit_z, units, plane_bytes, memory_bytes / 2);
        // A chunk is in memory twice while it is unpacked.
        let units_at_once = (memory_bytes / 4 / array.unit_bytes()).clamp(1, rayon_threads());
        let planes = Planes {
            bytes: Vec::new(),
            z: 0..0,
            dims_x: info.dims.x.into(),
            dims_y: info.dims.y.into(),
            voxel_bytes: array.voxel_bytes(),
        };
        Ok(Self { info, array, axes, picks, grouping, units_at_once, planes })
    }

    /// Decodes the planes `z`, chunk by chunk.
    fn load(&mut self, z: Range<u64>) -> Result<(), VolumeError> {
        // Until all of it is there, none of it is.
        self.planes.reset(z.clone(), self.array.fill_value());
        let planes = std::mem::replace(&mut self.planes.z, 0..0);
        self.array.forget_shards();
        let units = self.units(&z);
        let count: u64 = units.iter().map(|range| range.end - range.start).product();
        let part = self.axes.z.filter(|&axis| self.grouping.planes < self.array.unit[axis]);
        for first in (0..count).step_by(self.units_at_once as usize) {
            let batch = first..(first + self.units_at_once).min(count);
            let decode = |at| self.array.block(&unravel(at, &units), part.map(|axis| (axis, z.clone())));
            let blocks = batch.into_par_iter().map(decode).collect::<Result<Vec<_>, _>>()?;
            self.planes.z = planes.clone();
            for block in blocks.into_iter().flatten() {
                self.planes.paste(&block, &self.axes, &self.picks);
            }
            self.planes.z = 0..0;
        }
        self.planes.z = planes;
        Ok(())
    }

    /// Chunks along each dimension that hold something of the planes `z`.
    fn units(&self, z: &Range<u64>) -> Vec<Range<u64>> {
        let of = |axis: usize| {
            let unit = self.array.unit[axis];
            match axis {
                axis if axis == self.axes.x || axis == self.axes.y => {
                    0..self.array.shape[axis].div_ceil(unit)
                }
                axis if Some(axis) == self.axes.z => z.start / unit..z.end.div_ceil(unit),
                axis => self.picks[axis] / unit..self.picks[axis] / unit + 1,
            }
        };
        (0..self.axes.count).map(of).collect()
    }
}

impl VolumeReader for ZarrVolume {
    fn info(&self) -> &VolumeInfo {
        &self.info
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        assert!(z < self.info.dims.z && slab.len() == self.info.slab_voxels(), "slab {z} of {:?}", self.info);
        let z = u64::from(z);
        if !self.planes.z.contains(&z) {
            self.load(self.grouping.group(z, self.info.dims.z.into()))?;
        }
        let bytes = self.planes.plane_bytes();
        let start = (z - self.planes.z.start) as usize * bytes;
        let plane = &self.planes.bytes[start..start + bytes];
        match self.array.is_half {
            false => slab.bytes_mut().copy_from_slice(plane),
            true => (0..slab.len()).for_each(|i| {
                let half = f16::from_ne_bytes([plane[2 * i], plane[2 * i + 1]]);
                slab.set(i, half.to_f64());
            }),
        }
        debug_assert_eq!(slab.element(), if self.array.is_half { Element::F32 } else { self.array.element });
        Ok(())
    }
}

fn rayon_threads() -> u64 {
    rayon::current_num_threads() as u64
}

/// The indices of the chunk that is number `at` of those in the ranges, the last dimension fastest.
fn unravel(mut at: u64, ranges: &[Range<u64>]) -> Vec<u64> {
    let mut indices = vec![0; ranges.len()];
    for (index, range) in indices.iter_mut().zip(ranges).rev() {
        let count = range.end - range.start;
        *index = range.start + at % count;
        at /= count;
    }
    indices
}

fn selected_level<'a>(image: &'a Image, selection: &Selection) -> Result<&'a Level, VolumeError> {
    let wanted = selection.level.unwrap_or(0);
    image.levels.get(wanted as usize).ok_or_else(|| {
        let what = format!("it has no level {wanted}; its levels are {}", image.listing());
        VolumeError::unsupported(&image.folder, what)
    })
}

fn dims(folder: &Path, array: &LevelArray, axes: &Axes) -> Result<UVec3, VolumeError> {
    let [x, y, z] = [Some(axes.x), Some(axes.y), axes.z].map(|axis| axis.map_or(1, |a| array.shape[a]));
    let is_possible = [x, y, z].iter().all(|&n| n >= 1 && n <= u64::from(MAX_EDGE_VOXELS));
    match is_possible {
        true => Ok(UVec3::new(x as u32, y as u32, z as u32)),
        false => Err(VolumeError::header(
            folder,
            format!("the dimensions are [{x}, {y}, {z}], and each must be from 1 to {MAX_EDGE_VOXELS}"),
        )),
    }
}

/// The chosen channel and time, each of which must be said where there are several.
fn picks(
    folder: &Path,
    image: &Image,
    array: &LevelArray,
    axes: &Axes,
    selection: &Selection,
) -> Result<Vec<u64>, VolumeError> {
    let mut picks = vec![0; axes.count];
    let choices = [
        (axes.channel, selection.channel, "channel", &image.channels[..]),
        (axes.time, selection.time, "time", &[]),
    ];
    for (axis, wanted, what, labels) in choices {
        let count = axis.map_or(1, |axis| array.shape[axis]);
        let wanted = wanted.map(u64::from);
        let pick = wanted.or((count == 1).then_some(0)).filter(|&pick| pick < count);
        let pick = pick.ok_or_else(|| not_chosen(folder, count, wanted, what, labels))?;
        if let Some(axis) = axis {
            picks[axis] = pick;
        }
    }
    Ok(picks)
}

fn not_chosen(folder: &Path, count: u64, wanted: Option<u64>, what: &str, labels: &[String]) -> VolumeError {
    let labels = match labels.iter().all(String::is_empty) {
        true => String::new(),
        false => format!(" ({})", labels.join(", ")),
    };
    let many = match what {
        "time" => format!("{count} points in time"),
        _ => format!("{count} {what}s{labels}"),
    };
    let refused = wanted.map_or_else(String::new, |wanted| format!(" and no number {wanted}"));
    let last = count.saturating_sub(1);
    VolumeError::unsupported(folder, format!("it has {many}{refused}: choose its {what}, from 0 to {last}"))
}

fn frame(
    folder: &Path,
    level: &Level,
    axes: &Axes,
    selection: &Selection,
) -> Result<VolumeFrame, VolumeError> {
    if let Some(spacing_mm) = selection.spacing_mm {
        return sound(folder, VolumeFrame::of_voxels(spacing_mm * 1e-3));
    }
    if level.placement.is_none() || axes.has_unknown_unit {
        let path = folder.display();
        tracing::warn!(%path, "it does not give the edges of a voxel in a known unit: millimetres are assumed");
    }
    let at = |numbers: &[f64], axis: usize| numbers[axis] * axes.unit_m[axis];
    let (scale, translation) = match &level.placement {
        Some(placement) => (placement.scale.clone(), placement.translation.clone()),
        None => (vec![1.0; axes.count], vec![0.0; axes.count]),
    };
    if scale.len() != axes.count {
        let what = format!("a transformation has {} numbers for {} axes", scale.len(), axes.count);
        return Err(VolumeError::header(folder, what));
    }
    // A plane alone has no thickness of its own: its voxels are as thick as they are wide.
    let z = axes.z.map_or((at(&scale, axes.x), 0.0), |z| (at(&scale, z), at(&translation, z)));
    let size = DVec3::new(at(&scale, axes.x), at(&scale, axes.y), z.0);
    let origin_m = DVec3::new(at(&translation, axes.x), at(&translation, axes.y), z.1);
    sound(folder, VolumeFrame { origin_m, ..VolumeFrame::of_voxels(size) })
}

/// The frame, if a volume can lie so.
fn sound(folder: &Path, frame: VolumeFrame) -> Result<VolumeFrame, VolumeError> {
    match frame.is_sound() {
        true => Ok(frame),
        false => {
            let size_mm = frame.voxel_size_m() * 1e3;
            let what = format!("the voxel size is {size_mm} mm, and {}", VolumeFrame::SOUND_EDGES);
            Err(VolumeError::header(folder, what))
        }
    }
}
