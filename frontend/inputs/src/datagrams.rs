//! Sources that send datagrams to a port of this host.

use crate::Refusal;
use crate::dtrack::Dtrack;
use crate::opentrackio::Segments;
use crate::outbox::Outbox;
use crate::reading::Parts;
use crate::{freed, osc};
use rustix::net::{AddressFamily, SocketType, bind, ipproto, socket, sockopt};
use std::fmt;
use std::io::{ErrorKind, Result};
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::time::{Duration, Instant};

/// How soon a thread notices that it is to end.
pub(crate) const ATTENTION: Duration = Duration::from_millis(50);
/// A tracker that is silent for longer is lost.
const PATIENCE: Duration = Duration::from_secs(2);
/// No datagram is longer, bytes.
const LONGEST: usize = 1 << 16;

/// Where datagrams arrive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Port {
    /// At an address of this host.
    Own(SocketAddr),
    /// At the address of a group that this host joins, on the network of one of its own addresses.
    Group(SocketAddrV4, Ipv4Addr),
}

impl fmt::Display for Port {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Own(address) => address.fmt(out),
            Self::Group(group, interface) => write!(out, "{group} by {interface}"),
        }
    }
}

impl Port {
    fn open(self) -> Result<UdpSocket> {
        let port = match self {
            Self::Own(address) => UdpSocket::bind(address)?,
            Self::Group(group, interface) => {
                let port = socket(AddressFamily::INET, SocketType::DGRAM, Some(ipproto::UDP))?;
                // Several programs of a host may listen to a group. Bound to the group's own address, a socket gets no other
                // datagrams of the port.
                sockopt::set_socket_reuseaddr(&port, true)?;
                bind(&port, &group)?;
                let port = UdpSocket::from(port);
                port.join_multicast_v4(group.ip(), &interface)?;
                port
            }
        };
        port.set_read_timeout(Some(ATTENTION))?;
        Ok(port)
    }
}

/// What the datagrams of a port are.
pub(crate) enum Decoder {
    Dtrack(Dtrack),
    Freed,
    Osc,
    OpenTrackIo(Segments),
}

impl Decoder {
    fn decode(&mut self, datagram: &[u8]) -> std::result::Result<Parts, Refusal> {
        match self {
            Self::Dtrack(dtrack) => dtrack.decode(datagram),
            Self::Freed => freed::parse(datagram),
            Self::Osc => osc::parse(datagram),
            Self::OpenTrackIo(segments) => segments.decode(datagram),
        }
    }

    /// Whether a long silence means that the source is gone: a program sends when there is something to say.
    const fn is_steady(&self) -> bool {
        !matches!(self, Self::Osc)
    }
}

/// A port, and what arrives there.
pub(crate) struct Datagrams {
    pub port: Port,
    pub decoder: Decoder,
}

impl Datagrams {
    /// Listens until that fails or nobody wants it any more. Why it ended.
    pub fn attend(&mut self, outbox: &mut Outbox) -> String {
        match self.listen(outbox) {
            Ok(()) => String::new(),
            Err(error) => format!("cannot listen at {}: {error}; it is tried again", self.port),
        }
    }

    fn listen(&mut self, outbox: &mut Outbox) -> Result<()> {
        let socket = self.port.open()?;
        if !self.decoder.is_steady() {
            outbox.found(|| format!("listens at {}", self.port));
        }
        let mut datagram = vec![0; LONGEST];
        let mut heard = Instant::now();
        while !outbox.is_stopped() {
            if self.receive(&socket, &mut datagram, outbox)? {
                heard = Instant::now();
            } else if self.decoder.is_steady() && heard.elapsed() > PATIENCE {
                outbox.lost(|| {
                    format!(
                        "nothing has arrived at {} for {} s; it is listened to",
                        self.port,
                        PATIENCE.as_secs()
                    )
                });
            }
        }
        Ok(())
    }

    /// Waits a moment for a datagram. Whether one has come that says anything.
    fn receive(&mut self, socket: &UdpSocket, bytes: &mut [u8], outbox: &mut Outbox) -> Result<bool> {
        match socket.recv_from(bytes) {
            Ok((length, from)) => {
                let message = self.decoder.decode(&bytes[..length]);
                let is_heard = message.is_ok();
                if is_heard {
                    outbox.found(|| format!("is heard from {from} at {}", self.port));
                }
                outbox.take(message);
                Ok(is_heard)
            }
            Err(error) if is_passing(error.kind()) => Ok(false),
            Err(error) => Err(error),
        }
    }
}

/// Whether there is only nothing to read yet.
pub(crate) fn is_passing(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}
