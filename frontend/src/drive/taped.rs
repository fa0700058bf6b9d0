//! A tape that is played.

use super::{Input, Request};
use crate::FrontendError;
use crate::staging::{Theatre, check_number};
use exhibit::Exhibit;
use protocol::FrameState;
use std::collections::{BTreeMap, VecDeque};
use std::path::Path;
use std::time::Duration;
use tape::{AttachedFile, Frame, Head, Record, Tape};
use world::{Cast, Deed, Moment, Rules};

/// A tape.
pub struct Taped {
    head: Head,
    /// What it has of each frame: what happened before it, and the frame.
    frames: VecDeque<(Vec<Deed>, Frame)>,
    /// Whether its frames are made again one by one; otherwise they come when they came.
    by_frame: bool,
    /// When its first frame was made, and when that is played.
    began: Option<(Duration, Duration)>,
    /// Whether what is made again is compared with what was.
    compares: bool,
    /// The frame that is being made again.
    expected: Option<Frame>,
    /// Frames that are not what they were.
    different: u64,
    news: Vec<String>,
}

impl Taped {
    /// Reads a tape. One that ends early is played as far as it goes.
    ///
    /// # Errors
    /// It is no tape.
    pub fn open(path: &Path, by_frame: bool) -> Result<Self, FrontendError> {
        Ok(Self::of(&Tape::open(path)?, by_frame))
    }

    /// The same of a tape that is open.
    pub fn of(tape: &Tape, by_frame: bool) -> Self {
        let (mut frames, mut deeds, mut news) = (VecDeque::new(), Vec::new(), Vec::new());
        for record in tape.records() {
            match record {
                Ok(Record::Deed(deed)) => deeds.push(deed),
                Ok(Record::Frame(frame)) => frames.push_back((std::mem::take(&mut deeds), frame)),
                Ok(Record::Said(_)) => {}
                Err(error) => news.push(error.to_string()),
            }
        }
        let head = tape.head().clone();
        Self { head, frames, by_frame, began: None, compares: true, expected: None, different: 0, news }
    }

    /// The same for another scene than its own: nothing is compared with what it was.
    #[must_use]
    pub fn for_any_scene(self) -> Self {
        Self { compares: false, ..self }
    }

    /// Who took part, and what they may do, where it was recorded of an exhibit: that exhibit's file is on it.
    ///
    /// # Errors
    /// The file is no good exhibit.
    pub fn exhibit_cast(&self) -> Result<Option<(Cast, Rules)>, FrontendError> {
        let text = |file: &AttachedFile| String::from_utf8(file.bytes.clone()).ok();
        let mut texts = self.head.files.iter().filter_map(|file| Some((&file.name, text(file)?)));
        let Some((name, text)) = texts.find(|(_, text)| Exhibit::is_one(text)) else { return Ok(None) };
        let sources: Vec<&str> = self.head.sources.iter().map(String::as_str).collect();
        Ok(Some(Exhibit::cast_from_toml(&text, name, &sources)?))
    }

    /// Frames on it.
    pub fn len(&self) -> u32 {
        self.frames.len().try_into().unwrap_or(u32::MAX)
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Whether it was recorded with trackers or controllers.
    pub fn has_inputs(&self) -> bool {
        !self.head.sources.is_empty()
    }

    /// Makes frames of a tape again, those of a range, or the last one: all that happened before them happens in a theatre.
    ///
    /// # Errors
    /// It has no such frames, or the theatre cannot make them.
    pub fn remake(
        mut self,
        range: Option<(u32, u32)>,
        theatre: &mut Theatre,
    ) -> Result<Remade, FrontendError> {
        self.compare_files();
        let count = self.len();
        let (first, end) = range.unwrap_or((count.saturating_sub(1), count));
        if end > count || first >= end {
            return Err(FrontendError::Frames { first, end, count });
        }
        let mut frames = BTreeMap::new();
        for place in 0..end {
            let (mut requests, moment) = (Vec::new(), self.moment());
            let Some(moment) = moment else { break };
            self.poll(moment, &mut requests);
            for request in requests {
                if let Request::Deed(deed) = request {
                    theatre.apply(&deed);
                }
            }
            let frame = theatre.frame(place, moment)?;
            self.made(&frame);
            if place >= first {
                frames.insert(place, frame);
            }
        }
        Ok(Remade { frames, news: self.news() })
    }

    /// Tells which files are not what they were when it was recorded.
    pub fn compare_files(&mut self) {
        for file in self.head.files.iter().filter(|_| self.compares) {
            if std::fs::read(&file.name).is_ok_and(|bytes| bytes != file.bytes) {
                self.news.push(format!("{} is not what it was when the tape was recorded", file.name));
            }
        }
    }
}

/// Frames of a tape, made again.
pub struct Remade {
    /// By their place on the tape.
    pub frames: BTreeMap<u32, FrameState>,
    /// What is to be said of them.
    pub news: Vec<String>,
}

impl Input for Taped {
    fn moment(&mut self) -> Option<Moment> {
        let (_, frame) = self.frames.front().filter(|_| self.by_frame)?;
        Some(frame.moment())
    }

    fn poll(&mut self, moment: Moment, requests: &mut Vec<Request>) {
        if self.frames.is_empty() {
            requests.push(Request::Quit);
        }
        if self.by_frame {
            let next = self.frames.pop_front();
            self.expected = next.as_ref().map(|next| next.1);
            requests.extend(next.into_iter().flat_map(|next| next.0).map(Request::Deed));
            return;
        }
        while let Some((_, frame)) = self.frames.front() {
            let was = frame.moment().now;
            let (first, played) = *self.began.get_or_insert((was, moment.now));
            if was.saturating_sub(first) > moment.now.saturating_sub(played) {
                break;
            }
            let deeds = self.frames.pop_front().into_iter().flat_map(|next| next.0);
            requests.extend(deeds.map(|deed| Request::Deed(later(deed, first, played))));
        }
    }

    fn made(&mut self, frame: &FrameState) {
        let Some(expected) = self.expected.take().filter(|_| self.compares) else { return };
        if check_number(frame).is_ok_and(|check| check == expected.check) {
            return;
        }
        self.different += 1;
        if self.different == 1 {
            let number = expected.frame;
            self.news.push(format!(
                "frame {number} of the tape is not what it was: its scene, its display or this program has changed"
            ));
        }
    }

    fn news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }
}

/// A deed on another clock, on which `first` is `played`.
fn later(deed: Deed, first: Duration, played: Duration) -> Deed {
    let moved = |time: Duration| (time + played).saturating_sub(first);
    match deed {
        Deed::Event(mut event) => {
            event.received = moved(event.received);
            if let Some(inputs::DeviceTime::InStep(time)) = &mut event.device_time {
                *time = moved(*time);
            }
            Deed::Event(event)
        }
        change => change,
    }
}
