//! The array of one level: what is in it, and its chunks one by one.

use super::bounded;
use super::files::Files;
use bricks::volume::{Element, VolumeError};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zarrs::array::{
    Array, ArrayBytes, ArrayCreateError, ArrayError, ArrayMetadata, ArrayShardedExt, ArrayShardedReadableExt,
    ArrayShardedReadableExtCache, ArraySubset, CodecOptions,
};
use zarrs::plugin::ExtensionName;

/// Largest chunk that is decoded, unless the user allows more memory.
const MOST_CHUNK_BYTES: u64 = 2 << 30;
/// Largest table of inner chunks that a shard may have: 16 bytes each.
const MOST_SHARD_CHUNKS: u64 = 1 << 24;
/// Metadata and checksums that a packed chunk may have beside its voxels.
const MOST_OVERHEAD_BYTES: u64 = 1 << 20;

/// An open array.
pub(super) struct LevelArray {
    folder: PathBuf,
    array: Array<Files>,
    shards: ArrayShardedReadableExtCache,
    /// Voxels along each dimension.
    pub shape: Vec<u64>,
    /// Voxels of what is decoded at once, along each dimension: a chunk, or a shard's inner chunk.
    pub unit: Vec<u64>,
    /// The type of the numbers as they are handed out.
    pub element: Element,
    /// Whether they are half floats, which are handed out as f32.
    pub is_half: bool,
}

/// A decoded box of voxels, the last dimension fastest.
pub(super) struct Block {
    /// Place of its first voxel in the array.
    pub start: Vec<u64>,
    /// Voxels along each dimension.
    pub shape: Vec<u64>,
    /// Numbers in this machine's byte order.
    pub bytes: Vec<u8>,
}

impl LevelArray {
    /// Opens the array in a folder; no chunk of it is read.
    pub fn open(folder: &Path, memory_bytes: u64) -> Result<Self, VolumeError> {
        bounded::register();
        let files = |most_bytes| Arc::new(Files { root: folder.into(), most_bytes });
        let array = Array::open(files(MOST_CHUNK_BYTES), "/").map_err(|error| not_an_array(folder, error))?;
        let (element, is_half) = number_type(folder, &array)?;
        check_grid(folder, &array)?;
        let chunk = chunk_shape(folder, &array)?;
        let inner = if array.is_sharded() { array.effective_subchunk_shape() } else { None };
        let inner: Option<Vec<u64>> = inner.map(|shape| shape.iter().map(|n| n.get()).collect());
        if let Some(inner) = &inner {
            check_shard(folder, &chunk, inner)?;
        }
        let unit = inner.unwrap_or(chunk);
        let voxel_bytes = if is_half { 2 } else { element.bytes() as u64 };
        let bytes = check_unit(folder, &unit, voxel_bytes, memory_bytes)?;
        // Of a shard only its table and inner chunks are read, unless the shard as a whole is packed.
        let most_bytes = match array.is_sharded() {
            true => MOST_CHUNK_BYTES,
            false => bytes.saturating_mul(2).saturating_add(MOST_OVERHEAD_BYTES),
        };
        let array = array.with_storage(files(most_bytes));
        let shards = ArrayShardedReadableExtCache::new(&array);
        let shape = array.shape().to_vec();
        Ok(Self { folder: folder.into(), array, shards, shape, unit, element, is_half })
    }

    /// Bytes of a stored number.
    pub fn voxel_bytes(&self) -> usize {
        if self.is_half { 2 } else { self.element.bytes() }
    }

    /// Bytes of a decoded chunk.
    pub fn unit_bytes(&self) -> u64 {
        self.unit.iter().product::<u64>() * self.voxel_bytes() as u64
    }

    /// The number that stands where no chunk is, in this machine's byte order.
    pub fn fill_value(&self) -> &[u8] {
        self.array.fill_value().as_ne_bytes()
    }

    /// Forgets the tables of the shards read so far.
    pub fn forget_shards(&self) {
        self.shards.clear();
    }

    /// Decodes a chunk; None if it is not there. Of a chunk much thicker than the memory allows, only the `planes`
    /// of a dimension (in voxels of the array) may be asked for.
    pub fn block(
        &self,
        unit: &[u64],
        planes: Option<(usize, Range<u64>)>,
    ) -> Result<Option<Block>, VolumeError> {
        let mut start: Vec<u64> = unit.iter().zip(&self.unit).map(|(at, edge)| at * edge).collect();
        let mut shape = self.unit.clone();
        let bytes = match planes {
            Some((axis, planes)) if !self.shards.array_is_sharded() => {
                let mut within = vec![0; shape.len()];
                within[axis] = planes.start - start[axis];
                start[axis] = planes.start;
                shape[axis] = planes.end - planes.start;
                self.part(unit, within, &shape)
            }
            _ => self.whole(unit),
        };
        let bytes = bytes.map_err(|error| self.damaged(unit, &error.to_string()))?;
        let Some(bytes) = bytes else { return Ok(None) };
        let bytes = bytes.into_fixed().map_err(|error| self.damaged(unit, &error.to_string()))?.into_owned();
        let promised = shape.iter().product::<u64>() * self.voxel_bytes() as u64;
        match bytes.len() as u64 == promised {
            true => Ok(Some(Block { start, shape, bytes })),
            false => Err(self.damaged(unit, &format!("it holds {} bytes, not {promised}", bytes.len()))),
        }
    }

    fn whole(&self, unit: &[u64]) -> Result<Option<ArrayBytes<'static>>, ArrayError> {
        let options = CodecOptions::default().with_concurrent_target(1);
        match self.shards.array_is_sharded() {
            true => self.array.retrieve_subchunk_opt(&self.shards, unit, &options).map(Some),
            false => self.array.retrieve_chunk_if_exists_opt(unit, &options),
        }
    }

    fn part(
        &self,
        unit: &[u64],
        start: Vec<u64>,
        shape: &[u64],
    ) -> Result<Option<ArrayBytes<'static>>, ArrayError> {
        let options = CodecOptions::default().with_concurrent_target(1);
        let subset = ArraySubset::new_with_start_shape(start, shape.to_vec())?;
        self.array.retrieve_chunk_subset_opt(unit, &subset, &options).map(Some)
    }

    fn damaged(&self, unit: &[u64], what: &str) -> VolumeError {
        let (path, name) = match self.shards.array_is_sharded() {
            true => (self.folder.clone(), format!("inner chunk {unit:?} of its shards")),
            false => (self.array.storage().path(&self.array.chunk_key(unit)), format!("chunk {unit:?}")),
        };
        VolumeError::read(&path)(std::io::Error::other(format!("{name} cannot be decoded: {what}")))
    }
}

fn not_an_array(folder: &Path, error: ArrayCreateError) -> VolumeError {
    let what = error.to_string();
    match error {
        ArrayCreateError::CodecsCreateError(_) | ArrayCreateError::UnsupportedZarrV2Array(_) => {
            VolumeError::unsupported(folder, format!("{what}: write it again with blosc, zstd or gzip"))
        }
        ArrayCreateError::DataTypeCreateError(_) => {
            VolumeError::unsupported(folder, format!("{what}: write it again as integers or floats"))
        }
        _ => VolumeError::header(folder, what),
    }
}

fn number_type(folder: &Path, array: &Array<Files>) -> Result<(Element, bool), VolumeError> {
    let name = array.data_type().name_v3().unwrap_or_default();
    match &*name {
        "float16" => Ok((Element::F32, true)),
        "bool" => Ok((Element::U8, false)),
        name => Element::from_name(name).map(|element| (element, false)).ok_or_else(|| {
            let what = format!("its data type is {name}: write it again as integers or floats");
            VolumeError::unsupported(folder, what)
        }),
    }
}

fn check_grid(folder: &Path, array: &Array<Files>) -> Result<(), VolumeError> {
    match array.metadata() {
        ArrayMetadata::V3(metadata) if metadata.chunk_grid.name() != "regular" => {
            let what =
                format!("its chunk grid is {}: only regular ones are read", metadata.chunk_grid.name());
            Err(VolumeError::unsupported(folder, what))
        }
        _ => Ok(()),
    }
}

fn chunk_shape(folder: &Path, array: &Array<Files>) -> Result<Vec<u64>, VolumeError> {
    let first = vec![0; array.dimensionality()];
    let shape = array.chunk_shape(&first).map_err(|error| VolumeError::header(folder, error.to_string()))?;
    Ok(shape.iter().map(|edge| edge.get()).collect())
}

/// A shard's table is read whole, so it must be of a size that can be.
fn check_shard(folder: &Path, shard: &[u64], inner: &[u64]) -> Result<(), VolumeError> {
    let divides = shard.iter().zip(inner).all(|(shard, inner)| shard % inner == 0);
    let counts = shard.iter().zip(inner).map(|(shard, inner)| shard / inner);
    let chunks = counts.fold(1u64, u64::saturating_mul);
    match divides && chunks <= MOST_SHARD_CHUNKS {
        true => Ok(()),
        false => Err(VolumeError::header(
            folder,
            format!("its shards of {shard:?} hold chunks of {inner:?}, which cannot be right"),
        )),
    }
}

/// Bytes of a decoded chunk, where they are not too many.
fn check_unit(folder: &Path, unit: &[u64], voxel_bytes: u64, memory_bytes: u64) -> Result<u64, VolumeError> {
    let bytes = unit.iter().try_fold(voxel_bytes, |bytes, &edge| bytes.checked_mul(edge));
    let most = MOST_CHUNK_BYTES.max(memory_bytes);
    bytes.filter(|&bytes| bytes <= most).ok_or_else(|| {
        let what =
            format!("a chunk of {unit:?} takes more than {most} bytes: write it again in smaller chunks");
        VolumeError::unsupported(folder, what)
    })
}
