//! What a feedback table belongs to.

use bricks::NodeKey;
use layout::FeedbackEntry;
use protocol::FrameState;

/// What a feedback table belongs to: it travels with the table, so that nobody has to count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FeedbackTag {
    /// The nodes of the index that its frame was cast with, by their places.
    pub keys: Vec<NodeKey>,
    /// The frame, its time on a clock that does not run back.
    pub frame: Option<Box<FrameState>>,
    /// The configuration that the frame was a part of, if it was.
    pub configuration: Option<u32>,
}

/// A feedback table, one entry per place of the index, and what it belongs to.
pub type TaggedFeedback = (FeedbackTag, Vec<FeedbackEntry>);
