//! Volumes, opened for work in this process.

use crate::FrontendError;
use crate::scene::VolumeFacts;
use bricks::BrickSource;
use protocol::VolumeRef;
use std::sync::Arc;

/// Opens a volume just to learn what it is.
pub fn volume_facts(volume: &VolumeRef) -> Result<VolumeFacts, FrontendError> {
    Ok(VolumeFacts::of(open_volume(volume)?.as_ref()))
}

/// Opens a volume for work in this process.
pub fn open_volume(volume: &VolumeRef) -> Result<Arc<dyn BrickSource>, FrontendError> {
    backend::open_volume(volume).map_err(FrontendError::Volume)
}
