//! One file of a tape that is being written.

use crate::channels::Channels;
use crate::head::{Head, PROFILE};
use crate::record::Record;
use mcap::{Attachment, McapResult, WriteOptions};
use std::borrow::Cow;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::time::Duration;

/// What is written within this time can be lost when the process is killed.
const FLUSH_INTERVAL: Duration = Duration::from_secs(1);

/// A file.
pub struct Part {
    file: mcap::Writer<BufWriter<File>>,
    channels: Channels,
    flushed: Option<Duration>,
}

impl Part {
    /// Begins a file: its head and the files that go with it are on disk before anything else.
    pub fn create(path: &Path, head: &Head) -> McapResult<Self> {
        let options = WriteOptions::new().profile(PROFILE).library(format!("lightloom {}", head.version));
        let mut file = options.create(BufWriter::new(File::create(path)?))?;
        file.write_metadata(&head.metadata())?;
        for attached in &head.files {
            file.attach(&Attachment {
                log_time: head.began_ns,
                create_time: head.began_ns,
                name: attached.name.clone(),
                media_type: "application/octet-stream".to_owned(),
                data: Cow::Borrowed(&attached.bytes),
            })?;
        }
        let channels = Channels::add(&mut file, head)?;
        file.flush()?;
        Ok(Self { file, channels, flushed: None })
    }

    /// Adds a record that reached the world at a time of the display's clock.
    pub fn write(&mut self, now: Duration, record: &Record) -> McapResult<()> {
        if let Some((header, bytes)) = self.channels.encode(now, record) {
            self.file.write_to_known_channel(&header, &bytes)?;
        }
        if self.flushed.is_none_or(|flushed| now.saturating_sub(flushed) >= FLUSH_INTERVAL) {
            self.flushed = Some(now);
            self.file.flush()?;
        }
        Ok(())
    }

    /// Completes it.
    pub fn finish(mut self) -> McapResult<()> {
        self.file.finish()?;
        self.file.into_inner().into_inner().map_err(|error| error.into_error())?.sync_all()?;
        Ok(())
    }
}
