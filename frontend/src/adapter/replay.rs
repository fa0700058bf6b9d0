//! Traces and their volumes, for replays.

use super::volume::open_volume;
use crate::FrontendError;
use crate::same_file::identity;
use bricks::BrickSource;
use bricks::store::Store;
use protocol::VolumeRef;
use renderer::working_set::{
    Account, Policy, ReplayVolume, SAMPLE_BYTES, TraceHeader, TraceReader, TracedFrame, replay,
};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Traces that have been read, with their volumes, whose bricks are left alone.
pub struct Traces {
    traces: Vec<Trace>,
}

struct Trace {
    header: TraceHeader,
    frames: Vec<TracedFrame>,
    source: Arc<dyn BrickSource>,
    brick_bytes: u64,
}

/// What a policy makes of traces. Levels of deficit are those of [`Account`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReplayRow {
    /// Brick cache of a back-end, MiB.
    pub cache_mib: u64,
    /// Upload of a frame, MiB.
    pub upload_mib: u64,
    /// 10⁶ bytes per second of a disk; null where it is ∞.
    pub disk_mb_per_s: f64,
    /// Milliseconds from the beginning of a read to its first byte.
    pub disk_latency_ms: f64,
    /// Reads at a time.
    pub threads: u16,
    /// Time of a fade, seconds.
    pub fade_s: f64,
    /// What is fetched first: its name on the command line.
    pub order: String,
    /// Frames, those of every back-end counted.
    pub frames: u64,
    /// Bricks that came into a cache.
    pub bricks_loaded: u64,
    /// Those among them that had been there before.
    pub loaded_again: u64,
    /// 10⁶ bytes that disks read.
    pub mb_read: f64,
    /// Mean over frames of the mean deficit over rays, levels.
    pub mean_deficit: f64,
    /// Its 99th percentile, levels.
    pub high_deficit: f64,
    /// The largest deficit in the last frame, levels.
    pub deficit_at_end: f64,
    /// Seconds until the deficit first was 0; null where it never was.
    pub seconds_to_rest: Option<f64>,
    /// Families of eight that came.
    pub splits: u64,
    /// Families of eight that went.
    pub collapses: u64,
    /// Mean time of an update, milliseconds on one core.
    pub update_ms: f64,
}

impl Traces {
    /// Reads traces and opens their volumes, or the store `moved` instead of all of them.
    pub fn open(paths: &[PathBuf], moved: Option<&Path>) -> Result<Self, FrontendError> {
        let files: Vec<_> = paths.iter().map(|path| identity(path)).collect();
        let is_again = |place: usize| files[place].is_some() && files[..place].contains(&files[place]);
        if let Some(again) = (0..files.len()).find(|&place| is_again(place)) {
            let path = paths[again].display();
            return Err(FrontendError::Trace(format!("{path} is given twice; give every trace once")));
        }
        let traces = paths.iter().map(|path| Trace::open(path, moved)).collect::<Result<_, _>>()?;
        Ok(Self { traces })
    }

    /// What becomes of all of them under a policy.
    pub fn replay(&self, policy: &Policy) -> Account {
        let runs: Vec<_> = self.traces.iter().map(|trace| trace.replay(policy)).collect();
        Account::of(&runs)
    }
}

impl Trace {
    fn open(path: &Path, moved: Option<&Path>) -> Result<Self, FrontendError> {
        let sentence = |error: renderer::working_set::TraceError| FrontendError::Trace(error.to_string());
        let reader = TraceReader::open(path).map_err(sentence)?;
        let header = reader.header().clone();
        let volume = moved.map_or(header.volume.clone(), |path| VolumeRef::Store(path.to_owned()));
        let (source, brick_bytes) = open(&volume, moved.is_some())?;
        let (dims, recorded) = (source.shape().dims(), header.dims);
        if dims != recorded {
            return Err(FrontendError::Trace(format!(
                "{} was recorded of {recorded} voxels, and its volume has {dims}; give the store that was recorded \
                 with --volume",
                path.display()
            )));
        }
        let frames = reader.collect::<Result<Vec<_>, _>>().map_err(sentence)?;
        if frames.is_empty() {
            let why = "has no frames; record it again, with --live";
            return Err(FrontendError::Trace(format!("{} {why}", path.display())));
        }
        Ok(Self { header, frames, source, brick_bytes })
    }

    fn replay(&self, policy: &Policy) -> renderer::working_set::ReplayRun {
        let summary = |key| self.source.summary(key);
        let volume = ReplayVolume { summary: &summary, brick_bytes: self.brick_bytes };
        replay(&self.header, volume, policy, &self.frames)
    }
}

/// A volume, and the bytes of its bricks on disk: of a store on average, of what is made on the fly unpacked.
fn open(volume: &VolumeRef, is_given: bool) -> Result<(Arc<dyn BrickSource>, u64), FrontendError> {
    let VolumeRef::Store(path) = volume else { return Ok((open_volume(volume)?, SAMPLE_BYTES)) };
    let hint = if is_given { "" } else { "; if the store has moved, name it with --volume" };
    let store = Store::open(path).map_err(|error| FrontendError::Volume(format!("{error}{hint}")))?;
    let brick_bytes = store.file_bytes().div_ceil(store.stored_bricks().max(1));
    Ok((Arc::new(store), brick_bytes))
}
