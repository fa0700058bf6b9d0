//! What a store holds, and whether it is whole.

use super::LevelSummary;
use crate::FrontendError;
use crate::orientation::FrameFacts;
use crate::progress::Progress;
use bricks::BrickSource;
use bricks::store::{self, CodeBits, Codec, Store, StoreError};
use glam::UVec3;
use serde::Serialize;
use std::cell::RefCell;
use std::path::Path;

/// What is known of a store without reading its bricks.
#[derive(Clone, Debug, Serialize)]
pub struct StoreSummary {
    /// The volume it was built from.
    pub source: String,
    /// Version of the file's format.
    pub format_version: u32,
    /// Voxels along each axis.
    pub dims: UVec3,
    /// Size, orientation and place of the voxels.
    pub frame: FrameFacts,
    /// `CT`, `MR` or `unknown`, as the volume's file said.
    pub modality: String,
    /// Smallest and largest value.
    pub value_range: (f64, f64),
    /// Bits per code: 8 or 16.
    pub bits: u32,
    /// `none`, `lz4` or `zstd`.
    pub codec: &'static str,
    /// Levels, the root's included.
    pub levels: u32,
    /// Nodes of the octree.
    pub nodes: u64,
    /// Those whose bricks take bytes.
    pub stored_bricks: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// Bits of the file per voxel of the finest level.
    pub bits_per_voxel: f64,
    /// Whether coarse levels keep standard deviations.
    pub has_deviation: bool,
    /// Errors against the source, the finest level first; empty if an older program built the store.
    pub level_errors: Vec<LevelSummary>,
}

/// What a check of a store found.
#[derive(Clone, Debug, Serialize)]
pub struct VerifySummary {
    /// Whether all is as it was written.
    pub is_whole: bool,
    /// Bricks that were read.
    pub bricks: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// How many damages there are.
    pub damage_count: u64,
    /// A sentence for each of the first of them.
    pub damages: Vec<String>,
}

/// Opens a store and describes what it holds.
pub fn store_summary(path: &Path) -> Result<StoreSummary, FrontendError> {
    let store = Store::open(path).map_err(sentence)?;
    let (shape, bytes) = (store.shape(), store.file_bytes());
    let voxels = shape.dims().as_u64vec3().element_product();
    Ok(StoreSummary {
        source: store.source_name().to_owned(),
        format_version: store.version(),
        dims: shape.dims(),
        frame: FrameFacts::of(&store.frame()),
        modality: store.modality().to_string(),
        value_range: store.value_range(),
        bits: match store.bits() {
            CodeBits::Eight => 8,
            CodeBits::Sixteen => 16,
        },
        codec: codec_name(store.codec()),
        levels: u32::from(shape.finest_depth()) + 1,
        nodes: shape.total_node_count(),
        stored_bricks: store.stored_bricks(),
        bytes,
        bits_per_voxel: 8.0 * bytes as f64 / voxels as f64,
        has_deviation: store.has_deviation(),
        level_errors: LevelSummary::all(store.level_errors()),
    })
}

/// Reads and checks all of a store.
pub fn verify(path: &Path, progress: Progress) -> Result<VerifySummary, FrontendError> {
    let progress = RefCell::new(progress);
    let show = |done: u64, total: u64| progress.borrow_mut().set(done as f64 / total.max(1) as f64, "bricks");
    let found = store::verify(path, &show).map_err(sentence)?;
    Ok(VerifySummary {
        is_whole: found.damage_count == 0 && found.damages.is_empty(),
        bricks: found.bricks,
        bytes: found.bytes,
        damage_count: found.damage_count,
        damages: found.damages,
    })
}

fn sentence(error: StoreError) -> FrontendError {
    FrontendError::Volume(error.to_string())
}

fn codec_name(codec: Codec) -> &'static str {
    match codec {
        Codec::None => "none",
        Codec::Lz4 => "lz4",
        Codec::Zstd => "zstd",
    }
}
