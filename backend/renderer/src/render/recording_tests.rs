//! Live frames record what rays asked for, and a replay follows them.

use super::Renderer;
use super::test_scene::{draw, frame, options, renderer};
use crate::working_set::{
    DiskModel, FetchOrder, Policy, ReplayVolume, ReplayedFrame, TraceHeader, TraceReader, TracedFrame, replay,
};
use bricks::procedural::ProceduralVolume;
use bricks::volume::VolumeFrame;
use bricks::{Brick, BrickError, BrickSource, NodeKey, NodeSummary, OctreeShape};
use glam::UVec3;
use optics::Quality;
use protocol::{FrameReport, FrameState, Pace, VolumeRef};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

const FRAMES: u32 = 40;
const FRAME_S: f64 = 1.0 / 60.0;
const FADE_S: f64 = 0.1;
const UPLOAD_BYTES: u64 = 64 << 20;
/// A thread that the system put aside may make a brick a frame earlier or later than the replay's.
const LATE_FRAMES: usize = 2;

/// Shells whose bricks never come in the very frame that asks for them.
struct Unhurried(ProceduralVolume);

impl BrickSource for Unhurried {
    fn shape(&self) -> OctreeShape {
        self.0.shape()
    }

    fn frame(&self) -> VolumeFrame {
        self.0.frame()
    }

    fn value_range(&self) -> (f64, f64) {
        self.0.value_range()
    }

    fn summary(&self, node: NodeKey) -> NodeSummary {
        self.0.summary(node)
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        std::thread::sleep(Duration::from_millis(3));
        self.0.brick(node)
    }
}

fn source() -> Arc<dyn BrickSource> {
    Arc::new(Unhurried(ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap()))
}

fn live(index: u32) -> FrameState {
    let pace = Pace::Live { upload_bytes: UPLOAD_BYTES, fade_s: FADE_S };
    let time_s = f64::from(index) * FRAME_S;
    FrameState { index, time_s, pace, quality: Quality::default(), ..frame(0.3) }
}

/// A renderer that writes a trace.
fn recorder(path: PathBuf) -> Renderer {
    let mut renderer = renderer(source());
    renderer.record(path, &VolumeRef::Store("given by the test".into()));
    renderer
}

/// Draws live frames, each when all that the one before asked for has been read.
fn record(path: &Path) -> (Renderer, Vec<FrameReport>) {
    let mut renderer = recorder(path.to_owned());
    let mut reports = Vec::new();
    for index in 0..FRAMES {
        reports.push(draw(&mut renderer, &live(index)).unwrap().1);
        while !renderer.engine.stock.loader.is_idle() {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
    (renderer, reports)
}

fn read(path: &Path) -> (TraceHeader, Vec<TracedFrame>) {
    let reader = TraceReader::open(path).unwrap();
    (reader.header().clone(), reader.map(Result::unwrap).collect())
}

#[test]
fn a_trace_has_every_live_frame_with_its_own_rays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.trace");
    let (mut renderer, reports) = record(&path);
    assert!(!path.exists(), "a trace has no name before it is whole");
    renderer.finish().unwrap();
    let (header, frames) = read(&path);
    assert_eq!((header.dims, header.display.as_str()), (UVec3::splat(100), "test"));
    assert!(frames.iter().map(|frame| frame.index).eq(0..FRAMES));
    // A report shows what rays of the frame before met.
    for (frame, report) in frames.iter().zip(&reports[1..]) {
        assert_eq!(frame.demand.nodes().len() as u64, report.working_set_union, "frame {}", frame.index);
    }
    assert!(frames[FRAMES as usize - 1].demand.rays() > 1000);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_replay_by_the_recording_s_own_policy_follows_its_deficits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.trace");
    let (mut renderer, reports) = record(&path);
    renderer.finish().unwrap();
    let (header, frames) = read(&path);
    let source = source();
    let summary = |key| source.summary(key);
    let volume = ReplayVolume { summary: &summary, brick_bytes: 65536 };
    let disk = DiskModel { bytes_per_s: f64::INFINITY, latency_s: 1e-3, threads: 64 };
    let policy = Policy {
        cache_bytes: options().cache_bytes,
        upload_bytes: UPLOAD_BYTES,
        disk,
        fade_s: FADE_S,
        order: FetchOrder::Deficit,
    };
    let mean = |frame: &ReplayedFrame| frame.shortfall.map_or(0.0, |shortfall| shortfall.mean);
    let run = replay(&header, volume, &policy, &frames);
    let replayed: Vec<f64> = run.frames.iter().map(mean).collect();
    let recorded: Vec<f64> = reports[1..].iter().map(|report| report.upkeep.unwrap().mean_deficit).collect();
    for (at, deficit) in recorded.iter().enumerate() {
        let near = &replayed[at.saturating_sub(LATE_FRAMES)..(at + LATE_FRAMES + 1).min(replayed.len())];
        // The table's codes and the sum's order leave a little.
        let is_near = near.iter().any(|other| (other - deficit).abs() < 1e-3);
        assert!(is_near, "frame {at}: {deficit} recorded, {near:?} replayed");
    }
    // The canaries: there is something to follow, and it comes to rest.
    assert!(recorded.iter().any(|&deficit| deficit > 1.0) && recorded.last() == Some(&0.0), "{recorded:?}");
    let loaded: u64 = reports.iter().map(|report| report.bricks_loaded).sum();
    assert_eq!(run.frames.iter().map(|frame| frame.bricks_loaded).sum::<u64>(), loaded);
}

#[test]
fn a_trace_that_cannot_be_written_is_told_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.trace");
    std::fs::create_dir(&path).unwrap();
    std::fs::write(path.join("in the way"), "").unwrap();
    let error = record(&path).0.finish().unwrap_err().to_string();
    assert!(error.starts_with("cannot write trace ") && error.contains("a.trace"), "{error}");
    let mut renderer = recorder(folder.path().join("no/such/folder/a.trace"));
    let error = draw(&mut renderer, &live(0)).map(drop).unwrap_err().to_string();
    assert!(error.starts_with("cannot write trace "), "{error}");
}

#[test]
fn complete_frames_are_not_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let mut renderer = recorder(folder.path().join("a.trace"));
    draw(&mut renderer, &frame(0.3)).unwrap();
    renderer.finish().unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A run that is stopped in its first frame has nothing to tell; the trace of an earlier run has.
#[test]
fn a_trace_of_no_frame_takes_no_other_s_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.trace");
    std::fs::write(&path, "earlier").unwrap();
    let mut renderer = recorder(path.clone());
    renderer.restart(&live(0)).unwrap();
    let asked = std::sync::atomic::AtomicU32::new(0);
    let stop = || asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) > 0;
    assert!(renderer.advance(&stop).unwrap().report.is_none());
    renderer.finish().unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "earlier");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
