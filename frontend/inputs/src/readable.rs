//! Waits until there is something to read.

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use std::io::Result;
use std::os::fd::AsFd;
use std::time::Duration;

/// Which of some files or sockets can be read, after a while at the latest. One whose other end is gone can be read: it
/// ends.
pub(crate) fn await_readable<const N: usize>(files: [&dyn AsFd; N], at_most: Duration) -> Result<[bool; N]> {
    let mut polled = files.map(|file| PollFd::from_borrowed_fd(file.as_fd(), PollFlags::IN));
    let timeout = Timespec { tv_sec: at_most.as_secs() as i64, tv_nsec: at_most.subsec_nanos().into() };
    match poll(&mut polled, Some(&timeout)) {
        Ok(_) | Err(Errno::INTR) => Ok(polled.each_ref().map(|file| !file.revents().is_empty())),
        Err(error) => Err(error.into()),
    }
}
