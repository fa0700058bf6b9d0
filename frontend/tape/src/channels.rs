//! Where each record stands in the file, and how it is written.

use crate::head::Head;
use crate::record::{Record, nanoseconds};
use mcap::records::MessageHeader;
use serde_json::{Error, from_slice, to_vec};
use std::io::{Seek, Write};
use std::time::Duration;
use world::Deed;

/// What mouse and keys did.
const DESK: &str = "/desk";
/// Frames.
const FRAMES: &str = "/frames";
/// Sentences.
const LOG: &str = "/log";
/// Before the name of a source.
const INPUTS: &str = "/inputs/";

const EVENT_SCHEMA: &str = include_str!("schema/event.json");
const CHANGE_SCHEMA: &str = include_str!("schema/change.json");
const FRAME_SCHEMA: &str = include_str!("schema/frame.json");
const SAID_SCHEMA: &str = include_str!("schema/said.json");

/// What a channel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    Event,
    Change,
    Frame,
    Said,
}

impl Content {
    /// That of a channel by its topic; None for one that is not a tape's.
    pub fn of_topic(topic: &str) -> Option<Self> {
        match topic {
            DESK => Some(Self::Change),
            FRAMES => Some(Self::Frame),
            LOG => Some(Self::Said),
            topic => topic.starts_with(INPUTS).then_some(Self::Event),
        }
    }

    fn schema(self) -> (&'static str, &'static str) {
        match self {
            Self::Event => ("lightloom.Event", EVENT_SCHEMA),
            Self::Change => ("lightloom.Change", CHANGE_SCHEMA),
            Self::Frame => ("lightloom.Frame", FRAME_SCHEMA),
            Self::Said => ("lightloom.Said", SAID_SCHEMA),
        }
    }

    /// The record that a message is.
    ///
    /// # Errors
    /// It is none.
    pub fn decode(self, bytes: &[u8]) -> Result<Record, Error> {
        Ok(match self {
            Self::Event => Record::Deed(Deed::Event(from_slice(bytes)?)),
            Self::Change => Record::Deed(Deed::Change(from_slice(bytes)?)),
            Self::Frame => Record::Frame(from_slice(bytes)?),
            Self::Said => Record::Said(from_slice(bytes)?),
        })
    }
}

/// The channels of a tape that is written.
#[derive(Debug)]
pub struct Channels {
    sources: Vec<u16>,
    desk: u16,
    frames: u16,
    log: u16,
    began_ns: u64,
    sequence: u32,
}

impl Channels {
    /// Adds them to a file.
    pub fn add<W: Write + Seek>(file: &mut mcap::Writer<W>, head: &Head) -> mcap::McapResult<Self> {
        let mut add = |topic: &str| {
            let content = Content::of_topic(topic).expect("these are the topics of tapes");
            let (name, schema) = content.schema();
            let schema = file.add_schema(name, "jsonschema", schema.as_bytes())?;
            file.add_channel(schema, topic, "json", &Default::default())
        };
        Ok(Self {
            desk: add(DESK)?,
            frames: add(FRAMES)?,
            log: add(LOG)?,
            sources: head
                .sources
                .iter()
                .map(|name| add(&format!("{INPUTS}{name}")))
                .collect::<Result<_, _>>()?,
            began_ns: head.began_ns,
            sequence: 0,
        })
    }

    /// Where and how a record is written that reached the world at a time of the display's clock; None for one of a source
    /// that the tape does not know.
    pub fn encode(&mut self, now: Duration, record: &Record) -> Option<(MessageHeader, Vec<u8>)> {
        let (channel_id, bytes, measured) = match record {
            Record::Deed(Deed::Event(event)) => {
                let channel = self.sources.get(usize::from(event.source.0))?;
                (*channel, to_vec(event), event.measured())
            }
            Record::Deed(Deed::Change(change)) => (self.desk, to_vec(change), now),
            Record::Frame(frame) => (self.frames, to_vec(frame), now),
            Record::Said(said) => (self.log, to_vec(said), now),
        };
        self.sequence = self.sequence.wrapping_add(1);
        let on_wall = |time: Duration| self.began_ns.saturating_add(nanoseconds(time));
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: on_wall(now),
            publish_time: on_wall(measured),
        };
        Some((header, bytes.ok()?))
    }
}
