//! Which volume a scene shows, and what is known of it.

use super::SceneError;
use super::names::{PROCEDURAL_NAMES, PROCEDURAL_PREFIX};
use crate::orientation::FrameFacts;
use bricks::BrickSource;
use bricks::volume::VolumeFrame;
use glam::{DVec3, UVec3};
use serde::{Serialize, Serializer};
use std::path::PathBuf;

/// Edges of a procedural voxel, where a scene does not say.
pub(super) const PROCEDURAL_VOXEL_M: DVec3 = DVec3::splat(1e-3);
/// Voxels along an edge, unless the scene says otherwise.
const PROCEDURAL_EDGE: u32 = 256;
/// Voxels along an edge, at most.
pub(super) const LARGEST_EDGE: u32 = 1 << 20;

/// Which volume.
#[derive(Clone, Debug, PartialEq)]
pub enum VolumeSource {
    /// A brick store.
    Store(PathBuf),
    /// A field given by a formula.
    Procedural {
        /// One of [`PROCEDURAL_NAMES`].
        name: String,
        /// Voxels along each axis.
        dims: UVec3,
    },
}

impl VolumeSource {
    /// The volume of `procedural:NAME[@VOXELS]`; None for anything that does not begin so.
    pub fn parse_procedural(text: &str) -> Result<Option<Self>, SceneError> {
        text.strip_prefix(PROCEDURAL_PREFIX).map(Self::procedural).transpose()
    }

    /// The volume of `NAME` or `NAME@VOXELS`, without `procedural:` in front.
    pub(super) fn procedural(text: &str) -> Result<Self, SceneError> {
        let (name, size) = text.split_once('@').map_or((text, None), |(name, size)| (name, Some(size)));
        if !PROCEDURAL_NAMES.contains(&name) {
            return Err(SceneError::UnknownProcedural { name: name.to_owned() });
        }
        let edge = match size {
            None => PROCEDURAL_EDGE,
            Some(size) => edge_voxels(size)?,
        };
        Ok(Self::Procedural { name: name.to_owned(), dims: UVec3::splat(edge) })
    }
}

fn edge_voxels(size: &str) -> Result<u32, SceneError> {
    let wrong = || SceneError::ProceduralSize { size: size.to_owned(), largest: LARGEST_EDGE };
    size.parse().ok().filter(|edge| (1..=LARGEST_EDGE).contains(edge)).ok_or_else(wrong)
}

/// What a scene must know of a volume before it can be placed and coloured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VolumeFacts {
    /// Voxels along each axis.
    pub dims: UVec3,
    /// Size, orientation and place of the voxels, as the data say.
    #[serde(serialize_with = "as_facts")]
    pub frame: VolumeFrame,
    /// Smallest and largest data value.
    pub value_range: (f64, f64),
}

impl VolumeFacts {
    /// The facts of an open volume.
    pub fn of(volume: &dyn BrickSource) -> Self {
        Self { dims: volume.shape().dims(), frame: volume.frame(), value_range: volume.value_range() }
    }

    /// Edge lengths of a voxel as the data say, metres.
    pub fn voxel_size_m(&self) -> DVec3 {
        self.frame.voxel_size_m()
    }
}

fn as_facts<S: Serializer>(frame: &VolumeFrame, serializer: S) -> Result<S::Ok, S::Error> {
    FrameFacts::of(frame).serialize(serializer)
}
