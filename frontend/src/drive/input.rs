//! Where requests come from.

use super::Request;
use exhibit::InputStatus;
use protocol::FrameState;
use world::Moment;

/// A source of requests: a window, trackers, a tape.
pub trait Input {
    /// The moment of the next frame, if it is not for the display's clock to say.
    fn moment(&mut self) -> Option<Moment> {
        None
    }

    /// What has happened since it was last asked. The moment is that of the frame that is made next.
    fn poll(&mut self, moment: Moment, requests: &mut Vec<Request>);

    /// What its sources have said until now.
    fn counts(&self) -> Vec<InputStatus> {
        Vec::new()
    }

    /// The frame that was made.
    fn made(&mut self, _: &FrameState) {}

    /// What has become of its devices since it was last asked, in sentences.
    fn news(&mut self) -> Vec<String> {
        Vec::new()
    }
}
