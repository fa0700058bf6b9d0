//! Devices of this host that are read as events of one length: gamepads, and the SpaceMouse through spacenavd.

use crate::datagrams::{ATTENTION, is_passing};
use crate::outbox::Outbox;
use crate::readable::await_readable;
use crate::{gamepad, spacemouse};
use rustix::fs::{Mode, OFlags, open};
use std::fs::File;
use std::io::{Read, Result};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::path::PathBuf;

/// Events that are read at a time.
const AT_A_TIME: usize = 64;

/// A device and the path that it is read from.
pub(crate) enum Records {
    Gamepad(PathBuf),
    Spacemouse(PathBuf),
}

impl Records {
    /// Reads until the device is gone or nobody wants it any more. Why it ended.
    pub fn attend(&self, outbox: &mut Outbox) -> String {
        let (path, what) = match self {
            Self::Gamepad(path) => (path, "plug a gamepad in"),
            Self::Spacemouse(path) => (path, "start spacenavd"),
        };
        match self.read(outbox) {
            Ok(()) => format!("{} has ended; {what}", path.display()),
            Err(error) => format!("cannot read {}: {error}; {what}", path.display()),
        }
    }

    fn open(&self) -> Result<File> {
        match self {
            // Opening must not wait for a pipe's other end.
            Self::Gamepad(path) => Ok(File::from(open(
                path,
                OFlags::RDONLY | OFlags::NONBLOCK | OFlags::CLOEXEC,
                Mode::empty(),
            )?)),
            Self::Spacemouse(path) => {
                let stream = UnixStream::connect(path)?;
                stream.set_nonblocking(true)?;
                Ok(File::from(OwnedFd::from(stream)))
            }
        }
    }

    fn read(&self, outbox: &mut Outbox) -> Result<()> {
        let (length, path) = match self {
            Self::Gamepad(path) => (gamepad::LENGTH, path),
            Self::Spacemouse(path) => (spacemouse::LENGTH, path),
        };
        let mut file = self.open()?;
        outbox.found(|| format!("is read from {}", path.display()));
        let (mut bytes, mut filled) = (vec![0; AT_A_TIME * length], 0);
        while !outbox.is_stopped() {
            if !await_readable([&file], ATTENTION)?[0] {
                continue;
            }
            match file.read(&mut bytes[filled..]) {
                Ok(0) => return Ok(()),
                Ok(count) => filled += count,
                Err(error) if is_passing(error.kind()) => continue,
                Err(error) => return Err(error),
            }
            let whole = filled - filled % length;
            for event in bytes[..whole].chunks_exact(length) {
                outbox.take(match self {
                    Self::Gamepad(_) => gamepad::parse(event),
                    Self::Spacemouse(_) => spacemouse::parse(event),
                });
            }
            bytes.copy_within(whole..filled, 0);
            filled -= whole;
        }
        Ok(())
    }
}
