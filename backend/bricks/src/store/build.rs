//! Building a store from a volume, slab by slab.

use super::format::{Header, LONGEST_NAME};
use super::halve::halve;
use super::intake::{Taken, take};
use super::level::Level;
use super::node_table::NodeTable;
use super::pack::{PackRules, PackedBrick, Scratch, pack};
use super::sink::{Sink, folder_of};
use super::stream::{SLABS_UNDER_WAY, stream};
use super::tally::ErrorTally;
use super::{BuildOptions, BuildReport, LevelError, StoreError};
use crate::OctreeShape;
use crate::volume::{VolumeInfo, VolumeReader};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Bricks that are quantised and packed before they are written: some per core, not a whole layer of a huge volume.
const BRICKS_AT_ONCE: usize = 128;

/// So much may always be taken.
const LEAST_MEMORY_BYTES: u64 = 64 << 20;

/// Builds a store from a volume. `progress` gets (done, total) in slabs; a volume with non-finite values is
/// read twice. The file appears under its name only when it is complete.
///
/// # Errors
/// Any error of reading the volume or writing beside `out`, or a request to stop; no half-written file is left.
pub fn build(
    reader: &mut dyn VolumeReader,
    out: &Path,
    options: &BuildOptions,
    progress: &dyn Fn(u64, u64),
) -> Result<BuildReport, StoreError> {
    let started = Instant::now();
    let info = reader.info().clone();
    let slabs = u64::from(info.dims.z);
    let mut building = Building::start(&info, out, options)?;
    let stop = options.stop.clone();
    let should_stop = || stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed));
    let is_complete = stream(reader, &should_stop, |z, slab| {
        building.check_stop()?;
        building.non_finite += slab.replaced;
        let taken = take(&mut building.levels[0], z, &slab.stored, &info);
        building.taken = building.taken.merge(taken);
        building.slab_arrived(0, z)?;
        progress(u64::from(z) + 1, slabs);
        Ok::<_, StoreError>(())
    })?;
    if !is_complete {
        return Err(StoreError::Interrupted { path: out.into() });
    }
    building.finish(&info, started)
}

/// A build under way.
struct Building {
    path: PathBuf,
    options: BuildOptions,
    header: Header,
    /// Finest first, as all that follows.
    levels: Vec<Level>,
    /// Squared differences of the source to a level's means, all voxels added up.
    spread_squares: Vec<f64>,
    /// Errors of quantising the means, and the largest error against the source.
    packing: Vec<ErrorTally>,
    sink: Sink,
    taken: Taken,
    /// Of the finest level.
    brick_range: (f32, f32),
    non_finite: u64,
    emptied_bricks: u64,
}

impl Building {
    fn start(info: &VolumeInfo, out: &Path, options: &BuildOptions) -> Result<Self, StoreError> {
        let shape = OctreeShape::new(info.dims);
        let table = NodeTable::new(shape).ok_or_else(|| StoreError::Input {
            input: info.name.clone(),
            what: format!("{} voxels make too many bricks to count", info.dims),
        })?;
        let count = usize::from(shape.finest_depth()) + 1;
        let header = Header {
            bits: options.bits,
            codec: options.codec,
            has_deviation: options.has_deviation,
            dims: info.dims,
            frame: info.frame,
            modality: info.modality,
            value_range: (0.0, 0.0),
            nodes: table.nodes(),
            table_offset: 0,
            stored_bricks: None,
            levels: vec![LevelError::default(); count],
            source_name: shortened(&info.name),
        };
        let memory = memory_for_rings(info, shape, options)?;
        let sink = Sink::create(out, shape, header.length())?;
        Ok(Self {
            path: out.into(),
            options: options.clone(),
            header,
            levels: Level::all(shape, options.has_deviation, memory, folder_of(out))?,
            spread_squares: vec![0.0; count],
            packing: vec![ErrorTally::default(); count],
            sink,
            taken: Taken::nothing(),
            brick_range: (f32::INFINITY, f32::NEG_INFINITY),
            non_finite: 0,
            emptied_bricks: 0,
        })
    }

    fn check_stop(&self) -> Result<(), StoreError> {
        match self.options.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            true => Err(StoreError::Interrupted { path: self.path.clone() }),
            false => Ok(()),
        }
    }

    /// Writes the layers of bricks that a slab completes, and goes on with the coarser slab that it completes.
    fn slab_arrived(&mut self, level: usize, z: u32) -> Result<(), StoreError> {
        for layer in self.levels[level].layers_completed_by(z) {
            self.write_layer(level, layer)?;
        }
        let last = z + 1 == self.levels[level].dims.z;
        let (finer, coarser) = self.levels.split_at_mut(level + 1);
        match coarser.first_mut() {
            Some(coarse) if z % 2 == 1 || last => {
                self.spread_squares[level + 1] += halve(&finer[level], z, coarse, self.header.dims);
                self.slab_arrived(level + 1, z / 2)
            }
            _ => Ok(()),
        }
    }

    fn write_layer(&mut self, level: usize, layer: u32) -> Result<(), StoreError> {
        let (slabs, source) = (&self.levels[level], self.header.dims);
        let BuildOptions { bits, codec, ref emptiness, .. } = self.options;
        let rules = PackRules { bits, codec, emptiness, source };
        for nodes in slabs.layer_nodes(layer).chunks(BRICKS_AT_ONCE) {
            self.check_stop()?;
            let packed: Vec<PackedBrick> = nodes
                .par_iter()
                .map_init(Scratch::default, |scratch, &node| pack(slabs, node, &rules, scratch))
                .collect();
            for brick in packed {
                self.packing[level].merge(brick.errors);
                if level == 0 {
                    let (low, high) = brick.range;
                    self.brick_range = (self.brick_range.0.min(low), self.brick_range.1.max(high));
                }
                self.emptied_bricks += u64::from(brick.is_emptied);
                self.sink.put(brick)?;
            }
        }
        self.sink.end_layer(self.levels[level].depth, layer);
        Ok(())
    }

    /// Errors of the levels: what their means leave out, and what quantising them adds.
    fn level_errors(&self, voxels: u64) -> Vec<LevelError> {
        let rounding = self.taken.rounding;
        let mut spread = 0.0;
        let of_level = |(packing, squares): (&ErrorTally, &f64)| {
            spread += squares;
            let whole = ErrorTally { max: packing.max, squares: packing.squares + spread };
            LevelError { rms: whole.rms(voxels) + rounding.rms(voxels), max: whole.max + rounding.max }
        };
        self.packing.iter().zip(&self.spread_squares).map(of_level).collect()
    }

    fn finish(mut self, info: &VolumeInfo, started: Instant) -> Result<BuildReport, StoreError> {
        self.header.levels = self.level_errors(info.voxels());
        self.header.value_range = match self.taken.smallest <= self.taken.largest {
            true => (self.taken.smallest, self.taken.largest),
            false => (self.brick_range.0.into(), self.brick_range.1.into()),
        };
        let (levels, value_range, nodes) =
            (self.header.levels.clone(), self.header.value_range, self.header.nodes);
        let stored_bricks = self.sink.stored_bricks();
        let store_bytes = self.sink.finish(self.header)?;
        Ok(BuildReport {
            dims: info.dims,
            nodes,
            stored_bricks,
            emptied_bricks: self.emptied_bricks,
            source_bytes: info.bytes(),
            store_bytes,
            rms_error: levels[0].rms,
            max_error: levels[0].max,
            levels,
            non_finite: self.non_finite,
            value_range,
            duration: started.elapsed(),
        })
    }
}

/// What is left of the memory for the levels' slabs, after the slabs being read and the tiles' descriptions.
fn memory_for_rings(
    info: &VolumeInfo,
    shape: OctreeShape,
    options: &BuildOptions,
) -> Result<u64, StoreError> {
    let slabs = SLABS_UNDER_WAY as u64 * info.slab_voxels() as u64 * info.element.bytes() as u64;
    let tiles: u64 = (0..=shape.finest_depth()).map(|depth| Level::tile_bytes(shape.level_dims(depth))).sum();
    let least = slabs.saturating_add(tiles);
    if least > options.memory_bytes.max(LEAST_MEMORY_BYTES) {
        let (least, given) = (least >> 20, options.memory_bytes >> 20);
        let what =
            format!("slabs of {} need {least} MiB of memory, but only {given} MiB are allowed", info.dims);
        return Err(StoreError::Input { input: info.name.clone(), what });
    }
    Ok(options.memory_bytes.saturating_sub(least))
}

/// As much of a name as the header takes.
fn shortened(name: &str) -> String {
    let end = (0..=name.len().min(LONGEST_NAME)).rev().find(|&end| name.is_char_boundary(end));
    name[..end.unwrap_or(0)].into()
}
