//! Tapes that are read.

use crate::channels::Content;
use crate::error::TapeError;
use crate::flattened::Flattened;
use crate::head::{AttachedFile, FORMAT, Head, METADATA, PROFILE};
use crate::record::Record;
use mcap::records;
use memmap2::Mmap;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// A tape.
pub struct Tape {
    path: PathBuf,
    bytes: Box<dyn AsRef<[u8]> + Send + Sync>,
    head: Head,
}

impl Tape {
    /// Opens a tape, also one that was never completed.
    ///
    /// # Errors
    /// It cannot be read, it is no tape, or one of a later version.
    pub fn open(path: &Path) -> Result<Self, TapeError> {
        let cannot_read = |cause| TapeError::Read { path: path.to_owned(), cause };
        // Before it is opened: a pipe would wait for somebody who writes.
        if !std::fs::metadata(path).map_err(cannot_read)?.is_file() {
            return Err(cannot_read(std::io::Error::other("it is no regular file")));
        }
        let file = File::open(path).map_err(cannot_read)?;
        // SAFETY: a tape only grows while it is written; one that somebody shortens under a reader ends the process with a
        // bus error, and nothing else.
        let bytes = unsafe { Mmap::map(&file) }.map_err(cannot_read)?;
        Self::of(path, Box::new(bytes))
    }

    /// The same of a tape that is a part of the program, under a name for messages.
    ///
    /// # Errors
    /// It is no tape, or one of a later version.
    pub fn of_bytes(name: &Path, bytes: &'static [u8]) -> Result<Self, TapeError> {
        Self::of(name, Box::new(bytes))
    }

    fn of(path: &Path, bytes: Box<dyn AsRef<[u8]> + Send + Sync>) -> Result<Self, TapeError> {
        let mut tape = Self { path: path.to_owned(), bytes, head: Head::default() };
        tape.head = tape.read_head()?;
        Ok(tape)
    }

    /// What it says of itself.
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// Its records in their order. The last one is an error where the tape is damaged or was never completed.
    pub fn records(&self) -> impl Iterator<Item = Result<Record, TapeError>> + '_ {
        let mut pass =
            Pass { file: self.flattened(), channels: BTreeMap::new(), messages: 0, has_data_end: false };
        let (mut count, mut is_over) = (0, false);
        std::iter::from_fn(move || {
            let next = if is_over { None } else { pass.next() };
            is_over |= !matches!(next, Some(Ok(_)));
            count += u64::from(!is_over);
            let damaged = |what| TapeError::Damaged { path: self.path.clone(), records: count, what };
            next.map(|record| record.map_err(damaged))
        })
    }

    fn flattened(&self) -> Result<Flattened<'_>, String> {
        Flattened::new((*self.bytes).as_ref())
    }

    fn read_head(&self) -> Result<Head, TapeError> {
        let no_tape = |what: String| TapeError::NoTape { path: self.path.clone(), what };
        let mut found: Option<Head> = None;
        for record in self.flattened().map_err(no_tape)? {
            match record {
                Ok(records::Record::Header(header)) if header.profile != PROFILE => {
                    return Err(no_tape("it is an MCAP file of another program".to_owned()));
                }
                Ok(records::Record::Metadata(metadata)) if metadata.name == METADATA => {
                    let (format, head) = Head::of(&metadata.metadata)
                        .ok_or_else(|| no_tape("its head is incomplete".to_owned()))?;
                    if format > FORMAT {
                        return Err(TapeError::Newer {
                            path: self.path.clone(),
                            found: format,
                            known: FORMAT,
                        });
                    }
                    found = Some(head);
                }
                Ok(records::Record::Attachment { header, data, .. }) => {
                    let file = AttachedFile { name: header.name, bytes: data.into_owned() };
                    found.iter_mut().for_each(|head| head.files.push(file.clone()));
                }
                // All that belongs to the head stands before the first channel.
                Ok(records::Record::Channel(_) | records::Record::Message { .. }) => break,
                Ok(_) => {}
                Err(error) if found.is_none() => return Err(no_tape(error)),
                Err(_) => break,
            }
        }
        found.ok_or_else(|| no_tape("it has no head".to_owned()))
    }
}

/// A pass through a tape.
struct Pass<'a> {
    file: Result<Flattened<'a>, String>,
    channels: BTreeMap<u16, Option<Content>>,
    /// Messages until now: each carries its number, so that one that is missing is noticed.
    messages: u64,
    has_data_end: bool,
}

impl Pass<'_> {
    /// The next record, or what is wrong.
    fn next(&mut self) -> Option<Result<Record, String>> {
        loop {
            let next = match &mut self.file {
                Ok(file) => file.next(),
                Err(what) => return Some(Err(what.clone())),
            };
            match next {
                Some(Ok(records::Record::Channel(channel))) => {
                    self.channels.insert(channel.id, Content::of_topic(&channel.topic));
                }
                Some(Ok(records::Record::Message { header, data })) => {
                    self.messages += 1;
                    if header.sequence != self.messages as u32 {
                        return Some(Err("records are missing".to_owned()));
                    }
                    let content = self.channels.get(&header.channel_id).copied().flatten();
                    let decoded = content.ok_or("a record stands on a channel that no tape has".to_owned());
                    return Some(
                        decoded.and_then(|content| content.decode(&data).map_err(|error| error.to_string())),
                    );
                }
                Some(Ok(records::Record::DataEnd(_))) => self.has_data_end = true,
                Some(Ok(records::Record::Statistics(found))) if found.message_count != self.messages => {
                    return Some(Err(format!("{} records were written", found.message_count)));
                }
                Some(Ok(_)) => {}
                Some(Err(_)) | None if self.has_data_end => return None,
                Some(Err(what)) => return Some(Err(what)),
                None => return Some(Err("it was never completed".to_owned())),
            }
        }
    }
}
