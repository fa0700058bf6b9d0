//! How well one sensor, button or axis arrives.

use crate::report::{Histogram, Quantiles};
use inputs::{DeviceTime, Event, Pose, What};
use serde::Serialize;
use std::time::Duration;
use tracking::{ToolTrack, Tracked};

/// A sensor, button or axis of a source, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// Has poses.
    Sensor(u8),
    /// Is down or up.
    Button(u8),
    /// Has a value.
    Axis(u8),
}

/// What a channel said last.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Last {
    Pose(Option<Pose>),
    IsDown(bool),
    Value(f64),
}

impl Channel {
    /// The channel of an event, and what it says.
    pub(super) const fn of(what: &What) -> Option<(Self, Last)> {
        match what {
            What::Pose { sensor, pose } => Some((Self::Sensor(*sensor), Last::Pose(*pose))),
            What::Button { index, is_down } => Some((Self::Button(*index), Last::IsDown(*is_down))),
            What::Axis { index, value } => Some((Self::Axis(*index), Last::Value(*value))),
            What::Found(_) | What::Lost(_) => None,
        }
    }
}

/// Counts of a channel.
#[derive(Default)]
pub(super) struct Tally {
    events: u64,
    losses: u64,
    first: Duration,
    latest: Duration,
    gaps: Histogram,
    ages: Histogram,
    latest_age_ms: Option<f64>,
    last: Option<Last>,
    /// Of a sensor: the tool that somebody would hold.
    track: ToolTrack,
    /// Events when the rate was last asked for.
    before: u64,
}

impl Tally {
    pub fn add(&mut self, event: &Event, last: Last) {
        match self.events {
            0 => self.first = event.received,
            _ => self.gaps.add(event.received.saturating_sub(self.latest)),
        }
        if let Some(DeviceTime::InStep(time)) = event.device_time {
            // A device whose clock is ahead is 0 old.
            self.ages.add(event.received.saturating_sub(time));
            self.latest_age_ms = Some((event.received.as_secs_f64() - time.as_secs_f64()) * 1e3);
        }
        if let Last::Pose(pose) = last {
            self.track.push(event.measured(), pose);
        }
        let had_target = matches!(self.last, Some(Last::Pose(Some(_))));
        self.losses += u64::from(had_target && matches!(last, Last::Pose(None)));
        (self.events, self.latest, self.last) = (self.events + 1, event.received, Some(last));
    }

    /// Events since this was last asked for.
    pub const fn lap(&mut self) -> u64 {
        let since = self.events - self.before;
        self.before = self.events;
        since
    }

    pub fn report(&self, channel: Channel, now: Duration) -> ChannelReport {
        let span_s = self.latest.saturating_sub(self.first).as_secs_f64();
        let gap_ms = self.gaps.quantiles();
        ChannelReport {
            channel,
            events: self.events,
            losses: self.losses,
            rate_hz: if span_s > 0.0 { (self.events - 1) as f64 / span_s } else { 0.0 },
            jitter_ms: gap_ms.p99 - gap_ms.p50,
            gap_ms,
            age_ms: self.latest_age_ms.map(|_| self.ages.quantiles()),
            latest_age_ms: self.latest_age_ms,
            silent_s: now.saturating_sub(self.latest).as_secs_f64(),
            last: self.last,
            tool: self.track.at(now, now).map(|Tracked { pose, presence }| Tool { pose, presence }),
        }
    }
}

/// How well a channel arrived.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelReport {
    /// Which.
    pub channel: Channel,
    /// How often it said something.
    pub events: u64,
    /// How often its target was lost.
    pub losses: u64,
    /// How often it said something each second, from the first time to the last.
    pub rate_hz: f64,
    /// How much longer than half of all gaps 99 of a hundred of them are at most, milliseconds.
    pub jitter_ms: f64,
    /// Times between one arrival and the next, milliseconds.
    pub gap_ms: Quantiles,
    /// From the measurement to the arrival, milliseconds; absent where the device's clock is not in step with this host's.
    pub age_ms: Option<Quantiles>,
    /// The same of the latest, less than 0 where the device's clock is ahead.
    pub latest_age_ms: Option<f64>,
    /// Since it last said something, seconds.
    pub silent_s: f64,
    /// What it said last.
    pub(super) last: Option<Last>,
    /// The tool that a frame of now would show.
    pub(super) tool: Option<Tool>,
}

/// A tool at a sensor, filtered and predicted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Tool {
    pub pose: Pose,
    /// How much of it is there: it fades out where its target is lost.
    pub presence: f64,
}
