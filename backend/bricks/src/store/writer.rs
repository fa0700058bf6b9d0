//! A file written by a thread of its own, in order: the disk works while others pack.

use crossbeam_channel::{Receiver, Sender, bounded};
use std::fs::File;
use std::io::{self, Write};
use std::thread::JoinHandle;

/// Bytes handed over at once.
const PART_BYTES: usize = 1 << 20;
/// Parts that may wait.
const PARTS: usize = 32;
/// The disk is asked to take so many bytes at a time, so that little is left to wait for at the end.
const BYTES_BETWEEN_SYNCS: usize = 64 << 20;

/// What is written goes on from where the file was.
pub(super) struct Writer {
    part: Vec<u8>,
    parts: Option<Sender<Vec<u8>>>,
    thread: Option<JoinHandle<io::Result<File>>>,
}

impl Writer {
    pub fn new(file: File) -> Self {
        let (parts, inbox) = bounded(PARTS);
        let thread = std::thread::spawn(move || write_all(file, &inbox));
        Self { part: Vec::with_capacity(PART_BYTES), parts: Some(parts), thread: Some(thread) }
    }

    /// Waits until all is written, and gives the file back.
    pub fn finish(mut self) -> io::Result<File> {
        self.hand_over()?;
        self.end()
    }

    fn hand_over(&mut self) -> io::Result<()> {
        let part = std::mem::replace(&mut self.part, Vec::with_capacity(PART_BYTES));
        let is_taken = self.parts.as_ref().is_some_and(|parts| parts.send(part).is_ok());
        // A thread that takes no more has come upon an error.
        if is_taken { Ok(()) } else { self.end().map(|_| ()) }
    }

    fn end(&mut self) -> io::Result<File> {
        self.parts = None;
        let thread = self.thread.take().ok_or_else(|| io::Error::other("writing has ended before"))?;
        thread.join().unwrap_or_else(|_| Err(io::Error::other("writing failed inside the program")))
    }
}

impl Write for Writer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.part.extend_from_slice(bytes);
        if self.part.len() >= PART_BYTES {
            self.hand_over()?;
        }
        Ok(bytes.len())
    }

    /// None: [`Writer::finish`] returns whether all was written.
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        // Errors of an abandoned file do not matter.
        let _ = self.end();
    }
}

fn write_all(mut file: File, parts: &Receiver<Vec<u8>>) -> io::Result<File> {
    let mut since_sync = 0;
    for part in parts {
        file.write_all(&part)?;
        since_sync += part.len();
        if since_sync >= BYTES_BETWEEN_SYNCS {
            file.sync_data()?;
            since_sync = 0;
        }
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_written_in_order() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let mut writer = Writer::new(file.reopen().unwrap());
        let bytes: Vec<u8> = (0..3 * PART_BYTES + 17).map(|i| (i * i / 977) as u8).collect();
        bytes.chunks(70_001).for_each(|part| writer.write_all(part).unwrap());
        drop(writer.finish().unwrap());
        assert!(std::fs::read(file.path()).unwrap() == bytes);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told() {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let mut writer = Writer::new(full);
        let written = (0..200).try_for_each(|_| writer.write_all(&vec![0; PART_BYTES]));
        let error = written.and_then(|()| writer.finish().map(|_| ())).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}
