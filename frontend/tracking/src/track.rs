//! The track of one tool: from samples as they come to the tool that a frame shows.

use crate::filter::PoseFilter;
use crate::one_euro::OneEuro;
use crate::pose::Pose;
use crate::predictor::PosePredictor;
use crate::presence::Presence;
use std::time::Duration;

/// A sample that is older than the newest by more than this is none that was late: its clock has been set anew.
const MOST_LATE: Duration = Duration::from_secs(1);

/// How a tool's poses are filtered and predicted. The defaults are those of the study of tracking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackSettings {
    /// The filter of positions; speeds in m/s.
    pub position: OneEuro,
    /// The filter of rotations; speeds in rad/s.
    pub rotation: OneEuro,
    /// Of the prediction: samples count less by a factor of e for each such time that they are older.
    pub smoothing: Duration,
}

impl Default for TrackSettings {
    fn default() -> Self {
        Self {
            position: OneEuro { least_cutoff_hz: 0.5, cutoff_per_speed: 100.0, velocity_cutoff_hz: 1.0 },
            rotation: OneEuro { least_cutoff_hz: 0.5, cutoff_per_speed: 16.0, velocity_cutoff_hz: 1.0 },
            smoothing: Duration::from_millis(12),
        }
    }
}

/// A tool as a frame shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// Where it will be when the frame is seen.
    pub pose: Pose,
    /// How much of it is there, above 0 and at most 1.
    pub presence: f64,
}

/// What has become of a track's samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleCounts {
    /// With a pose that was taken in.
    pub poses: u64,
    /// Of a lost target.
    pub lost: u64,
    /// Left out: older than the newest.
    pub late: u64,
    /// Left out: of the same time as the newest.
    pub duplicate: u64,
    /// More than a second older than the newest: the clock was set back, and the track began anew.
    pub restarts: u64,
}

/// A tool's track. Its answers depend on nothing but its samples and the questions.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolTrack {
    filter: PoseFilter,
    predictor: PosePredictor,
    settings: TrackSettings,
    newest: Option<Duration>,
    presence: Option<Presence>,
    counts: SampleCounts,
}

impl Default for ToolTrack {
    fn default() -> Self {
        Self::new(TrackSettings::default())
    }
}

impl ToolTrack {
    /// A track without samples.
    pub fn new(settings: TrackSettings) -> Self {
        Self {
            filter: PoseFilter::new(settings.position, settings.rotation),
            predictor: PosePredictor::new(settings.smoothing),
            settings,
            newest: None,
            presence: None,
            counts: SampleCounts::default(),
        }
    }

    /// Takes a sample in: the pose in the display's frame, measured at a time of the display's clock; None where the tracker
    /// has lost the target. Samples that come too late are counted, and change nothing.
    pub fn push(&mut self, at: Duration, sample: Option<Pose>) {
        match self.newest {
            Some(newest) if at == newest => return self.counts.duplicate += 1,
            Some(newest) if at < newest && newest - at <= MOST_LATE => return self.counts.late += 1,
            Some(newest) if at < newest => self.restart(at),
            _ => {}
        }
        self.newest = Some(at);
        let Some(pose) = sample else { return self.counts.lost += 1 };
        self.counts.poses += 1;
        let amount = self.presence.map_or(0.0, |presence| presence.at(at));
        self.presence = Some(Presence { seen: at, amount });
        let filtered = self.filter.step(at, pose);
        self.predictor.step(at, filtered);
    }

    /// Forgets the course of the tool, but not that it is there.
    fn restart(&mut self, at: Duration) {
        self.counts.restarts += 1;
        self.filter = PoseFilter::new(self.settings.position, self.settings.rotation);
        self.predictor = PosePredictor::new(self.settings.smoothing);
        self.presence = self.presence.map(|presence| Presence { seen: at, ..presence });
    }

    /// The tool in the frame that is made `now` and seen at `seen_at`, both of the display's clock; None where there is
    /// nothing of it.
    ///
    /// A lost target is held for 0.5 s where it was last expected to be; then its tool fades out within 0.3 s. One that comes
    /// back is at once where it is now, and fades in from what was left of it.
    pub fn at(&self, now: Duration, seen_at: Duration) -> Option<Tracked> {
        let presence = self.presence?.at(now);
        let pose = self.predictor.pose_at(seen_at)?;
        (presence > 0.0).then_some(Tracked { pose, presence })
    }

    /// What has become of its samples so far.
    pub fn counts(&self) -> SampleCounts {
        self.counts
    }
}

#[cfg(test)]
#[path = "track_tests.rs"]
mod tests;
