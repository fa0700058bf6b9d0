//! From what a user names, a file or a procedural volume, to a store.

use super::{BuildOptions, BuildReport, StoreError, build};
use crate::volume::procedural::ProceduralVolume;
use crate::volume::{Selection, VolumeReader, open};
use glam::UVec3;
use std::path::Path;

/// What an input starts with that names a procedural volume.
pub const PROCEDURAL_PREFIX: &str = "procedural:";

/// How to import.
#[derive(Clone, Debug)]
pub struct ImportOptions {
    /// How to build the store.
    pub build: BuildOptions,
    /// Voxels of a procedural volume along each axis; a file has its own.
    pub procedural_dims: UVec3,
    /// Edge of a procedural volume's voxels in metres.
    pub procedural_voxel_m: f64,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self { build: BuildOptions::default(), procedural_dims: UVec3::splat(256), procedural_voxel_m: 1e-3 }
    }
}

/// Builds the store `out` from `input`: a volume file (of which `selection` says more), or `procedural:NAME`.
///
/// # Errors
/// Those of [`open`] and [`build`].
pub fn import(
    input: &str,
    selection: &Selection,
    out: &Path,
    options: &ImportOptions,
    progress: &dyn Fn(u64, u64),
) -> Result<BuildReport, StoreError> {
    let mut reader: Box<dyn VolumeReader> = match input.strip_prefix(PROCEDURAL_PREFIX) {
        Some(name) => {
            Box::new(ProceduralVolume::new(name, options.procedural_dims, options.procedural_voxel_m)?)
        }
        None => open(Path::new(input), selection)?,
    };
    build(reader.as_mut(), out, &options.build, progress)
}
