//! Building a store from a volume, slab by slab.

use super::format::{Entry, Header, LONGEST_NAME};
use super::node_table::NodeTable;
use super::sink::{PackedBrick, Sink, folder_of};
use super::slabs::LevelSlabs;
use super::survey::{Cleaner, ErrorTally, SourceTally};
use super::{
    BRICK_EDGE, Brick, CodeBits, Codec, NodeKey, OVERLAP, OWN_EDGE, OctreeShape, StoreError, quantise,
};
use crate::volume::{Samples, VolumeInfo, VolumeReader};
use glam::UVec3;
use rayon::prelude::*;
use shaders::optics::Optics;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Bricks that are quantised and packed before they are written: some per core, not a whole layer of a huge volume.
const BRICKS_AT_ONCE: usize = 128;

/// Which bricks are not worth keeping: they read back as their smallest value everywhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Emptiness {
    /// Only bricks whose samples are all equal, which lose nothing.
    #[default]
    Lossless,
    /// Bricks whose largest value is below this one.
    Below(f64),
    /// Bricks that these transfer functions do not show.
    Invisible(Optics),
}

/// How far a level is from the source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelError {
    /// Root mean square over all voxels of the source, of the difference to the level's voxel around them, data units.
    pub rms: f64,
    /// The largest difference.
    pub max: f64,
}

/// How to build.
#[derive(Clone, Debug)]
pub struct BuildOptions {
    /// Bits per code.
    pub bits: CodeBits,
    /// Compression of the bricks.
    pub codec: Codec,
    /// Memory for the slabs of all levels; where they need more, they are kept in a working file beside the store.
    pub memory_bytes: u64,
    /// Which bricks are left out.
    pub emptiness: Emptiness,
    /// Whether coarse levels keep the standard deviation of what their voxels stand for, beside its mean.
    pub has_deviation: bool,
    /// The build ends with an error soon after this becomes true.
    pub stop: Option<Arc<AtomicBool>>,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            bits: CodeBits::Eight,
            codec: Codec::Lz4,
            memory_bytes: 2 << 30,
            emptiness: Emptiness::Lossless,
            has_deviation: false,
            stop: None,
        }
    }
}

/// What a build did.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildReport {
    /// Voxels of the source along each axis.
    pub dims: UVec3,
    /// Nodes of the octree, and those that took any bytes; all samples of the others are equal.
    pub nodes: u64,
    /// See `nodes`.
    pub stored_bricks: u64,
    /// Bytes of the source's voxels, unpacked.
    pub source_bytes: u64,
    /// Bytes of the store.
    pub store_bytes: u64,
    /// Root mean square error of the finest level against the source, in data units; an upper bound where the
    /// source's values are not exact in f32, where the rounding's own RMS is added.
    pub rms_error: f64,
    /// Largest error of the finest level, in data units, with the same remark.
    pub max_error: f64,
    /// Errors of all levels, the finest first.
    pub levels: Vec<LevelError>,
    /// Bricks left out by [`BuildOptions::emptiness`] that were not of one value.
    pub emptied_bricks: u64,
    /// Voxels that were NaN, infinite or beyond f32, and were replaced by the smallest or largest finite value.
    pub non_finite: u64,
    /// Smallest and largest finite value.
    pub value_range: (f64, f64),
    /// Time it took.
    pub duration: Duration,
}

/// Builds a store from a volume. `progress` is told (done, total) in slabs read; float volumes are read twice, the
/// first time for their finite range. The file appears under its name only when it is complete.
///
/// # Errors
/// What reading the volume or writing beside `out` came upon; no half-written file is left.
pub fn build(
    reader: &mut dyn VolumeReader,
    out: &Path,
    options: &BuildOptions,
    progress: &dyn Fn(u64, u64),
) -> Result<BuildReport, StoreError> {
    let started = Instant::now();
    let mut building = Building::start(reader.info(), out, options)?;
    let slabs = u64::from(reader.info().dims.z);
    let info = reader.info().clone();
    let (cleaner, before) = match info.is_all_finite() {
        true => (None, 0),
        false => (Some(Cleaner::survey(reader, &|done| progress(done, 2 * slabs))?), slabs),
    };
    let mut stored = Samples::new(info.element, info.slab_voxels());
    let mut slab = vec![0.0; info.slab_voxels()];
    for z in 0..info.dims.z {
        reader.read_slab(z, &mut stored)?;
        slab.iter_mut().enumerate().for_each(|(i, value)| *value = info.value(stored.get(i)));
        building.source.non_finite += cleaner.map_or(0, |cleaner| cleaner.clean(&mut slab));
        building.take_slab(z, &slab)?;
        progress(before + u64::from(z) + 1, before + slabs);
    }
    building.finish(reader.info(), started)
}

/// A build under way.
struct Building {
    options: BuildOptions,
    header: Header,
    /// Finest first.
    levels: Vec<LevelSlabs>,
    sink: Sink,
    source: SourceTally,
    quantisation: ErrorTally,
}

impl Building {
    fn start(info: &VolumeInfo, out: &Path, options: &BuildOptions) -> Result<Self, StoreError> {
        let shape = OctreeShape::new(info.dims);
        let table = NodeTable::new(shape).ok_or_else(|| StoreError::Input {
            input: info.name.clone(),
            what: format!("{} voxels make more bricks than can be counted", info.dims),
        })?;
        let header = Header {
            bits: options.bits,
            codec: options.codec,
            dims: info.dims,
            voxel_size_m: info.frame.voxel_size_m(),
            value_range: (0.0, 0.0),
            nodes: table.nodes(),
            source_name: shortened(&info.name),
        };
        let sink = Sink::create(out, shape, table, &header)?;
        let levels = LevelSlabs::all(shape, options.memory_bytes, folder_of(out))?;
        let (source, quantisation) = (SourceTally::new(), ErrorTally::default());
        Ok(Self { options: options.clone(), header, levels, sink, source, quantisation })
    }

    fn take_slab(&mut self, z: u32, values: &[f64]) -> Result<(), StoreError> {
        self.source.take(values, self.levels[0].slab_mut(z));
        self.slab_arrived(0, z)
    }

    /// Writes the layers of bricks that a slab completes, and goes on with the coarser slab that it completes.
    fn slab_arrived(&mut self, level: usize, z: u32) -> Result<(), StoreError> {
        for layer in self.levels[level].layers_completed_by(z) {
            self.write_layer(level, layer)?;
        }
        let last = z + 1 == self.levels[level].dims().z;
        let (finer, coarser) = self.levels.split_at_mut(level + 1);
        match coarser.first_mut() {
            Some(coarse) if z % 2 == 1 || last => {
                finer[level].halve(z, coarse.slab_mut(z / 2));
                self.slab_arrived(level + 1, z / 2)
            }
            _ => Ok(()),
        }
    }

    fn write_layer(&mut self, level: usize, layer: u32) -> Result<(), StoreError> {
        let slabs = &self.levels[level];
        for nodes in slabs.layer_nodes(layer).chunks(BRICKS_AT_ONCE) {
            let packed: Vec<_> =
                nodes.par_iter().map(|&node| pack(slabs, node, &self.options, level == 0)).collect();
            for (brick, errors) in packed {
                self.sink.put(brick)?;
                self.quantisation.merge(errors);
            }
        }
        Ok(())
    }

    fn finish(mut self, info: &VolumeInfo, started: Instant) -> Result<BuildReport, StoreError> {
        self.header.value_range = (self.source.smallest, self.source.largest);
        let (stored_bricks, store_bytes) = (self.sink.stored_bricks(), self.sink.bytes());
        self.sink.finish(&self.header)?;
        Ok(BuildReport {
            dims: info.dims,
            nodes: self.header.nodes,
            stored_bricks,
            source_bytes: info.bytes(),
            store_bytes,
            rms_error: self.quantisation.rms() + self.source.rounding.rms(),
            levels: Vec::new(),
            emptied_bricks: 0,
            max_error: self.quantisation.max() + self.source.rounding.max(),
            non_finite: self.source.non_finite,
            value_range: self.header.value_range,
            duration: started.elapsed(),
        })
    }
}

/// Quantises and packs the brick of a node; its errors are only looked at where they are asked for.
fn pack(
    slabs: &LevelSlabs,
    node: NodeKey,
    options: &BuildOptions,
    with_errors: bool,
) -> (PackedBrick, ErrorTally) {
    let samples = slabs.samples(node);
    let brick = quantise(&samples, options.bits);
    let errors =
        if with_errors { own_errors(&brick, &samples, node, slabs.dims()) } else { ErrorTally::default() };
    let max = samples.iter().copied().fold(brick.low, f32::max);
    let bytes = if brick.step == 0.0 { Vec::new() } else { options.codec.pack(&brick.codes) };
    let entry = Entry { min: brick.low, max, low: brick.low, step: brick.step, offset: 0, length: 0 };
    (PackedBrick { node, entry, bytes }, errors)
}

/// Errors of the node's own voxels, without overlap and without what lies beyond the level's extent.
fn own_errors(brick: &Brick, samples: &[f32], node: NodeKey, dims: UVec3) -> ErrorTally {
    let mut errors = ErrorTally::default();
    let own = UVec3::splat(OWN_EDGE as u32).min(dims - node.cell * OWN_EDGE as u32).as_usizevec3();
    for k in OVERLAP..OVERLAP + own.z {
        for j in OVERLAP..OVERLAP + own.y {
            let row = (k * BRICK_EDGE + j) * BRICK_EDGE + OVERLAP;
            (row..row + own.x).for_each(|index| errors.add(brick.value(index) - f64::from(samples[index])));
        }
    }
    errors
}

/// As much of a name as the header takes.
fn shortened(name: &str) -> String {
    let end = (0..=name.len().min(LONGEST_NAME)).rev().find(|&end| name.is_char_boundary(end));
    name[..end.unwrap_or(0)].into()
}
