//! Which frame of the beat the screens of a back-end show, and from when on.

use std::collections::{BTreeMap, BTreeSet};

/// A back-end is ahead of its screens by a frame or two, and behind its orders by as many as it is late.
const MOST_ORDERED: usize = 1024;

/// What is drawn, and what is to be shown when. Times are on the back-end's clock, microseconds.
#[derive(Debug, Default)]
pub struct Stage {
    /// Frames that are drawn and have not been shown.
    drawn: BTreeSet<u32>,
    /// When frames are to be shown that have not been.
    ordered: BTreeMap<u32, u64>,
}

impl Stage {
    /// A frame is drawn.
    pub fn drawn(&mut self, frame: u32) {
        self.drawn.insert(frame);
    }

    /// A frame is to be shown at a time, or as soon as it is drawn if that is later.
    pub fn order(&mut self, frame: u32, at_us: u64) {
        self.ordered.insert(frame, at_us);
        // Of those that are never drawn.
        while self.ordered.len() > MOST_ORDERED {
            self.ordered.pop_first();
        }
    }

    /// Another frame is asked for: those that are drawn and have no order by now never get one.
    pub fn asked(&mut self) {
        let Self { drawn, ordered } = self;
        drawn.retain(|frame| ordered.contains_key(frame));
    }

    /// Whether a frame may still be shown.
    pub fn awaits(&self, frame: u32) -> bool {
        self.drawn.contains(&frame)
    }

    /// The frame to show next, and when: of those whose time has come the latest, or else the first to come.
    pub fn due(&self, now_us: u64) -> Option<(u32, u64)> {
        let ready = self.drawn.iter().filter_map(|&frame| Some((frame, *self.ordered.get(&frame)?)));
        let has_come = ready.clone().rfind(|&(_, at_us)| at_us <= now_us);
        has_come.or_else(|| ready.min_by_key(|&(_, at_us)| at_us))
    }

    /// The frame to ready: the one to show next, or else the first that waits for an order.
    pub fn next(&self, now_us: u64) -> Option<u32> {
        self.due(now_us).map(|(frame, _)| frame).or_else(|| self.drawn.first().copied())
    }

    /// A frame is shown; those before it never are.
    pub fn shown(&mut self, frame: u32) {
        self.drawn.retain(|&drawn| drawn > frame);
        self.ordered.retain(|&ordered, _| ordered > frame);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_shown_once_it_is_drawn_and_due() {
        let mut stage = Stage::default();
        stage.drawn(3);
        assert_eq!(stage.due(900), None, "nobody ordered it");
        stage.order(3, 700);
        assert_eq!(stage.due(100), Some((3, 700)));
        stage.drawn(4);
        stage.order(4, 800);
        assert_eq!(stage.due(100), Some((3, 700)), "one after the other");
        stage.shown(3);
        assert_eq!(stage.due(750), Some((4, 800)));
    }

    #[test]
    fn a_frame_that_was_kept_back_is_forgotten() {
        let mut stage = Stage::default();
        (3..6).for_each(|frame| stage.drawn(frame));
        stage.order(4, 700);
        stage.asked();
        assert_eq!([3, 4, 5].map(|frame| stage.awaits(frame)), [false, true, false]);
        assert_eq!(stage.next(100), Some(4));
    }

    #[test]
    fn a_late_frame_is_shown_at_once_and_an_older_one_never_after_it() {
        let mut stage = Stage::default();
        stage.order(5, 100);
        stage.order(6, 200);
        stage.drawn(5);
        assert_eq!(stage.due(150), Some((5, 100)));
        stage.drawn(6);
        assert_eq!(stage.due(150), Some((5, 100)));
        assert_eq!(stage.due(250), Some((6, 200)), "of two whose time has come, the latest");
        stage.shown(6);
        assert_eq!(stage.due(250), None);
    }
}
