//! What a world knows of a tool besides its place in the cast.

use crate::cast::{Sensor, Tool, ToolKind};
use crate::deed::Moment;
use crate::grip::Hand;
use glam::{DQuat, DVec3};
use inputs::SourceId;
use std::collections::BTreeSet;
use std::time::Duration;
use tracking::{Pose, ToolTrack};

/// A tool that has moved by so much since somebody did something with it is in somebody's hand, metres.
const MOVES_M: f64 = 0.03;
/// The cosine of half the angle, 8°, by which it turns then.
const TURNS: f64 = 0.997_564;

/// A tool's state.
#[derive(Clone, Debug)]
pub struct ToolState {
    sensor: Option<(SourceId, u8)>,
    track: ToolTrack,
    /// Which of its kinds it is.
    pub kind: usize,
    /// Buttons of its source that are down.
    pub down: BTreeSet<u8>,
    /// How far each of its dials is out.
    pub dials: Vec<f64>,
    /// Where it is in this frame, and how much of it is there.
    pub shown: Option<(Hand, f64)>,
    /// Where it was when it last counted as moved.
    anchor: Option<Hand>,
}

impl ToolState {
    /// Of a tool of which nothing is known yet.
    pub fn new(tool: &Tool) -> Self {
        let sensor = match tool.sensor {
            Sensor::Of { source, sensor } => Some((source, sensor)),
            Sensor::First => None,
        };
        Self {
            sensor,
            track: ToolTrack::new(tool.track),
            kind: 0,
            down: BTreeSet::new(),
            dials: vec![0.0; tool.dials.len()],
            shown: None,
            anchor: None,
        }
    }

    /// Where it is tracked, if that is known.
    pub fn sensor(&self) -> Option<(SourceId, u8)> {
        self.sensor
    }

    /// Whether its buttons and dials are those of a source.
    pub fn is_of(&self, source: SourceId) -> bool {
        self.sensor.is_some_and(|(own, _)| own == source)
    }

    /// It is tracked here from now on.
    pub fn bind(&mut self, source: SourceId, sensor: u8) {
        self.sensor = Some((source, sensor));
    }

    /// A sample of its sensor.
    pub fn push(&mut self, tool: &Tool, at: Duration, sensor: Option<Pose>) {
        let tip = sensor.and_then(|pose| {
            let to_tip = tool.sensor_from_tip;
            let position_m = pose.position_m() + pose.rotation() * to_tip.translation_m;
            Pose::new(position_m, pose.rotation() * to_tip.rotation)
        });
        self.track.push(at, tip);
    }

    /// Moves it to where it will be when the frame is seen. Whether somebody must have moved it.
    pub fn step(&mut self, moment: Moment) -> bool {
        self.shown = self.track.at(moment.now, moment.seen_at).map(|found| {
            let hand = Hand { tip_m: found.pose.position_m(), rotation: found.pose.rotation() };
            (hand, found.presence)
        });
        let Some((hand, _)) = self.shown else { return false };
        let is_moved = self.anchor.is_none_or(|anchor| has_moved(&anchor, &hand));
        if is_moved {
            self.anchor = Some(hand);
        }
        is_moved
    }

    /// What it is now.
    pub fn kind_of(&self, tool: &Tool) -> ToolKind {
        tool.kinds.get(self.kind).copied().unwrap_or(ToolKind::Pointer)
    }
}

fn has_moved(from: &Hand, to: &Hand) -> bool {
    let same_way: DQuat = from.rotation;
    let moved: DVec3 = to.tip_m - from.tip_m;
    moved.length() > MOVES_M || same_way.dot(to.rotation).abs() < TURNS
}
