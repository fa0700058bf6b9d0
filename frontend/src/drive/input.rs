//! Where requests come from.

use super::Request;
use world::Moment;

/// A source of requests: a window, trackers, a tape.
pub trait Input {
    /// What has happened since it was last asked. The moment is that of the frame that is made next.
    fn poll(&mut self, moment: Moment, requests: &mut Vec<Request>);

    /// What has become of its devices since it was last asked, in sentences.
    fn news(&mut self) -> Vec<String> {
        Vec::new()
    }
}
