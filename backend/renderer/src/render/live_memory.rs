//! What live frames remember of each other.

use crate::working_set::Feedback;
use bricks::LodRule;
use display_config::Display;
use protocol::FrameState;

/// What live frames remember of each other.
#[derive(Debug, Default)]
pub(super) struct Live {
    /// What rays saw in the frame before.
    pub(super) last: Option<FrameState>,
    /// By how much the renderer's clock, which never runs back, is ahead of the frames', seconds.
    pub(super) ahead_s: f64,
    /// What the rays of the latest frame that is known of found.
    pub(super) met: Vec<Feedback>,
    /// Of which configuration that was, if it was of one: what its parts found belongs together.
    pub(super) met_of: Option<u32>,
    /// Whether that was the frame before.
    pub(super) is_fresh: bool,
}

impl Live {
    /// A new frame, whose clock may have run back. Whether it shows what the one before showed.
    pub(super) fn enter(&mut self, frame: &FrameState) -> bool {
        let last_s = self.last.as_ref().map_or(0.0, |last| last.time_s);
        self.ahead_s += (last_s - frame.time_s).max(0.0);
        self.last.as_ref().is_some_and(|last| *last == FrameState { time_s: last.time_s, ..as_seen(frame) })
    }

    pub(super) fn now_s(&self, frame: &FrameState) -> f64 {
        frame.time_s + self.ahead_s
    }

    /// What the frame before asked for, and when.
    pub(super) fn before(&self, display: &Display) -> Option<(LodRule, f64)> {
        let last = self.last.as_ref()?;
        let rule = LodRule::new(display, last.display_from_volume, last.quality.lod_scale);
        Some((rule, self.now_s(last)))
    }
}

/// A frame as far as rays see it: numbers do not matter, nor which pixels were cast, nor what is drawn over them.
pub(super) fn as_seen(frame: &FrameState) -> FrameState {
    FrameState { index: 0, sub_frame: None, refinement: None, marks: Vec::new(), ..frame.clone() }
}
