//! What frames show of a tool, some time after the tracker measured it.

use super::hand::{Hand, Place};
use super::tracker::Sample;
use glam::{DQuat, DVec3};
use std::time::Duration;
use tracking::{Pose, PoseFilter, PosePredictor, ToolTrack, TrackSettings};

/// Frames a second.
const RATE_HZ: f64 = 60.0;
/// What comes before is not looked at, seconds: filters settle.
const SETTLING_S: f64 = 1.0;

/// What a frame makes of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// It shows the newest one.
    Raw,
    /// It filters them.
    Filtered,
    /// It predicts from them, unfiltered.
    Predicted,
    /// It filters and predicts: what a tool's track does.
    Track,
}

/// Where a tool is shown, and where it is at that time.
pub type Shown = (Place, Place);

/// A method with what it remembers.
struct Viewer {
    method: Method,
    filter: PoseFilter,
    predictor: PosePredictor,
    track: ToolTrack,
    newest: Option<Pose>,
}

impl Viewer {
    fn new(method: Method, settings: &TrackSettings) -> Self {
        Self {
            method,
            filter: PoseFilter::new(settings.position, settings.rotation),
            predictor: PosePredictor::new(settings.smoothing),
            track: ToolTrack::new(*settings),
            newest: None,
        }
    }

    fn push(&mut self, (at, sample): Sample) {
        self.track.push(at, sample);
        let Some(pose) = sample else { return };
        self.predictor.step(at, pose);
        let filtered = self.filter.step(at, pose);
        self.newest = Some(if self.method == Method::Filtered { filtered } else { pose });
    }

    fn pose(&self, now: Duration, seen_at: Duration) -> Option<Pose> {
        match self.method {
            Method::Raw | Method::Filtered => self.newest,
            Method::Predicted => self.predictor.pose_at(seen_at),
            Method::Track => self.track.at(now, seen_at).map(|tracked| tracked.pose),
        }
    }
}

/// The frames of a time of `time_s` seconds, each of which knows the samples that are at least `latency` old when it is seen.
pub fn view(
    hand: &Hand,
    samples: &[Sample],
    time_s: f64,
    latency: Duration,
    method: Method,
    settings: &TrackSettings,
) -> Vec<Shown> {
    let (mut viewer, mut waiting) = (Viewer::new(method, settings), samples.iter().peekable());
    let mut shown = Vec::new();
    for frame in 0..(time_s * RATE_HZ) as u32 {
        let seen_at = latency + Duration::from_secs_f64(f64::from(frame) / RATE_HZ);
        let now = seen_at - latency;
        while let Some(sample) = waiting.next_if(|(at, _)| *at <= now) {
            viewer.push(*sample);
        }
        let pose = viewer.pose(now, seen_at).filter(|_| now.as_secs_f64() >= SETTLING_S);
        shown.extend(pose.map(|pose| (place(&pose), hand.place(seen_at.as_secs_f64()))));
    }
    shown
}

fn place(pose: &Pose) -> (DVec3, DQuat) {
    (pose.position_m(), pose.rotation())
}
