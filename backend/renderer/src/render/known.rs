//! Which pixels of the device's pictures are as rays see them now.

use super::live_memory::as_seen;
use crate::present::Classes;
use protocol::FrameState;
use twin::Lattice;

/// What the device's pictures were cast for, the same for all views.
#[derive(Debug, Default)]
pub(super) struct Known {
    /// The frame that was begun last, as rays see it.
    seen: Option<FrameState>,
    /// The pixels that have been cast since rays last saw something else.
    classes: Classes,
}

impl Known {
    /// A frame begins to cast the pixels of a lattice; `stays` if what else rays see is as it was. The pixels that will
    /// be known once it has.
    pub(super) fn begin(&mut self, frame: &FrameState, stays: bool, lattice: &Lattice) -> Classes {
        let seen = FrameState { time_s: 0.0, ..as_seen(frame) };
        let is_same = stays && self.seen.as_ref() == Some(&seen);
        let cast = Classes::of_lattice(lattice);
        // A frame that is left off leaves the pixels that it casts as nobody knows.
        self.classes = if is_same { self.classes.without(cast) } else { Classes::default() };
        self.seen = Some(seen);
        self.classes.with(cast)
    }

    /// The frame has cast them.
    pub(super) fn end(&mut self, known: Classes) {
        self.classes = known;
    }

    /// A frame of another kind uses the pictures.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }
}
