//! What keeps a record of a show.

use super::BeatSummary;
use crate::FrontendError;
use crate::staging::{Theatre, check_number};
use exhibit::InputStatus;
use protocol::FrameState;
use std::time::Duration;
use tape::{Frame, Record, Said, Writer};
use world::{Deed, Moment};

/// A record: a tape, a log, a file with the state of things.
pub trait Recorder {
    /// Something happens, and is told to the world before the next frame.
    fn deed(&mut self, _now: Duration, _deed: &Deed) {}

    /// A frame is made. `beat` says how the beat is kept until now.
    ///
    /// # Errors
    /// The show cannot go on without the record.
    fn frame(
        &mut self,
        frame: &FrameState,
        moment: Moment,
        theatre: &Theatre,
        beat: &dyn Fn() -> BeatSummary,
    ) -> Result<(), FrontendError>;

    /// What sources of inputs have said until now.
    fn inputs(&mut self, _inputs: Vec<InputStatus>) {}

    /// Somebody is told something.
    fn said(&mut self, now: Duration, sentence: &str);

    /// What has become of the record itself since it was last asked, in sentences.
    fn news(&mut self) -> Vec<String> {
        Vec::new()
    }
}

impl Recorder for Writer {
    fn deed(&mut self, now: Duration, deed: &Deed) {
        self.write(now, Record::Deed(deed.clone()));
    }

    fn frame(
        &mut self,
        frame: &FrameState,
        moment: Moment,
        _: &Theatre,
        _: &dyn Fn() -> BeatSummary,
    ) -> Result<(), FrontendError> {
        let record = Frame::new(frame.index, moment, check_number(frame)?);
        self.write(moment.now, Record::Frame(record));
        Ok(())
    }

    fn said(&mut self, now: Duration, sentence: &str) {
        let now_ns = now.as_nanos().try_into().unwrap_or(u64::MAX);
        self.write(now, Record::Said(Said { now_ns, text: sentence.to_owned() }));
    }

    fn news(&mut self) -> Vec<String> {
        Self::news(self)
    }
}
