//! The sockets of a VRPN client.

use super::session::Session;
use super::wire::{self, COOKIE, Message};
use crate::Refusal;
use crate::datagrams::{ATTENTION, is_passing};
use crate::outbox::Outbox;
use crate::readable::await_readable;
use rustix::net::sockopt;
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream, ToSocketAddrs, UdpSocket};
use std::time::{Duration, Instant};

/// How long a server may take to answer.
const ANSWER: Duration = Duration::from_secs(1);
/// How long a server may take to describe its devices.
const DESCRIPTION: Duration = Duration::from_secs(3);
/// How long a message may take to arrive, from its first byte to its last: servers write each at once. Without it a wrong
/// length would swallow all that follows, for as long as that is fewer bytes than it says.
const WHOLE: Duration = Duration::from_secs(1);
/// A server that does not acknowledge anything is lost after some 8 s: the system asks after 5 s, three times.
const QUIET: Duration = Duration::from_secs(5);
const ASK_AGAIN: Duration = Duration::from_secs(1);
const ASKED: u32 = 3;
/// Bytes that are read at a time. A message of the greatest length fits in twice as many.
const AT_A_TIME: usize = wire::LONGEST + 8;

/// A client of one device of a server.
pub(crate) struct Client {
    /// Host and port.
    pub address: String,
    /// The device's name at the server.
    pub device: String,
    /// Whether the server may send datagrams.
    pub takes_datagrams: bool,
}

/// A server that has answered.
struct Connected {
    server: IpAddr,
    stream: TcpStream,
    datagrams: Option<UdpSocket>,
    session: Session,
    /// What was read last.
    bytes: Vec<u8>,
    pending: Pending,
}

/// What has arrived by the stream and is not whole yet.
struct Pending {
    bytes: Vec<u8>,
    /// Since when its first message has been waited for.
    since: Instant,
}

impl Client {
    /// Listens to the server until it is gone or nobody wants it any more. Why it ended.
    pub fn attend(&self, outbox: &mut Outbox) -> String {
        let Self { address, device, .. } = self;
        let mut connected = match self.connect() {
            Ok(connected) => connected,
            Err(error) => return format!("no VRPN server answers at {address}: {error}; it is tried again"),
        };
        let began = Instant::now();
        while !outbox.is_stopped() {
            match connected.heard(outbox) {
                Ok(true) => {}
                Ok(false) => return format!("the VRPN server at {address} has left; it is looked for"),
                Err(error) => {
                    return format!("the VRPN server at {address} is lost: {error}; it is looked for");
                }
            }
            if connected.session.has_device() {
                outbox.found(|| format!("`{device}` is heard from {address}"));
            } else if began.elapsed() > DESCRIPTION {
                outbox.lost(|| {
                    format!(
                        "the VRPN server at {address} has no device `{device}`; check its name at the server"
                    )
                });
            }
        }
        String::new()
    }

    fn connect(&self) -> Result<Connected> {
        let nowhere = || Error::new(ErrorKind::NotFound, "the host has no address");
        let server = self.address.to_socket_addrs()?.next().ok_or_else(nowhere)?;
        // Servers of today accept connections; all servers connect back if they are asked to.
        let mut stream = TcpStream::connect_timeout(&server, ANSWER).or_else(|_| called_back(server))?;
        stream.set_nodelay(true)?;
        keep_asking(&stream)?;
        stream.set_read_timeout(Some(ANSWER))?;
        stream.write_all(&COOKIE)?;
        let mut cookie = [0; COOKIE.len()];
        stream.read_exact(&mut cookie)?;
        wire::check_cookie(&cookie).map_err(|refusal| invalid("its cookie is refused", refusal))?;
        let datagrams = if self.takes_datagrams { Some(offer_datagrams(&mut stream)?) } else { None };
        stream.set_nonblocking(true)?;
        let session = Session::new(&self.device);
        let (bytes, pending) = (vec![0; AT_A_TIME], Pending::new(Instant::now()));
        Ok(Connected { server: server.ip(), stream, datagrams, session, bytes, pending })
    }
}

fn invalid(what: &str, refusal: Refusal) -> Error {
    Error::new(ErrorKind::InvalidData, format!("{what}, {refusal}"))
}

/// Asks a server to connect to this host. Only for that, a port is open, on the address by which this host reaches the
/// server.
fn called_back(server: SocketAddr) -> Result<TcpStream> {
    let caller = UdpSocket::bind(if server.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" })?;
    caller.connect(server)?;
    let own = caller.local_addr()?.ip();
    let listener = TcpListener::bind((own, 0))?;
    listener.set_nonblocking(true)?;
    caller.send(format!("{own} {}\0", listener.local_addr()?.port()).as_bytes())?;
    let began = Instant::now();
    while began.elapsed() < ANSWER {
        if await_readable([&listener], ATTENTION)?[0]
            && let Ok((stream, from)) = listener.accept()
            && from.ip() == server.ip()
        {
            stream.set_nonblocking(false)?;
            return Ok(stream);
        }
    }
    Err(Error::new(ErrorKind::TimedOut, "it neither accepts a connection nor makes one"))
}

/// Lets the system find out whether the server's host is still there.
fn keep_asking(stream: &TcpStream) -> Result<()> {
    sockopt::set_socket_keepalive(stream, true)?;
    sockopt::set_tcp_keepidle(stream, QUIET)?;
    sockopt::set_tcp_keepintvl(stream, ASK_AGAIN)?;
    sockopt::set_tcp_keepcnt(stream, ASKED)?;
    Ok(())
}

/// Opens a port for datagrams beside a connection, and says so.
fn offer_datagrams(stream: &mut TcpStream) -> Result<UdpSocket> {
    let own = stream.local_addr()?.ip();
    let datagrams = UdpSocket::bind((own, 0))?;
    datagrams.set_nonblocking(true)?;
    let (port, host) = (datagrams.local_addr()?.port(), format!("{own}\0"));
    let offer =
        Message { time: Duration::ZERO, sender: port.into(), kind: wire::UDP, payload: host.as_bytes() };
    stream.write_all(&wire::write(&offer, 0))?;
    Ok(datagrams)
}

impl Connected {
    /// Waits a moment for what the server says. Whether it is still there.
    fn heard(&mut self, outbox: &mut Outbox) -> Result<bool> {
        match self.datagrams.take() {
            None => {
                await_readable([&self.stream], ATTENTION)?;
            }
            Some(datagrams) => {
                await_readable([&self.stream, &datagrams], ATTENTION)?;
                self.take_datagrams(&datagrams, outbox)?;
                self.datagrams = Some(datagrams);
            }
        }
        self.take_stream(outbox)
    }

    fn take_datagrams(&mut self, datagrams: &UdpSocket, outbox: &mut Outbox) -> Result<()> {
        match datagrams.recv_from(&mut self.bytes) {
            Ok((length, from)) if from.ip() == self.server => {
                let heard = hear(&mut self.session, &self.bytes[..length], outbox);
                if heard != Ok(Heard { taken: length, leaves: false }) {
                    outbox.take(Err(Refusal::Form));
                }
                Ok(())
            }
            Ok(_) => Ok(()),
            Err(error) if is_passing(error.kind()) => Ok(()),
            Err(error) => Err(error),
        }
    }

    fn take_stream(&mut self, outbox: &mut Outbox) -> Result<bool> {
        let now = Instant::now();
        let arrived = match self.stream.read(&mut self.bytes) {
            Ok(0) => return Ok(false),
            Ok(count) => &self.bytes[..count],
            Err(error) if is_passing(error.kind()) => &[],
            Err(error) => return Err(error),
        };
        let leaves = self.pending.hear(arrived, now, &mut self.session, outbox).map_err(|refusal| {
            outbox.take(Err(refusal));
            invalid("a message is refused", refusal)
        })?;
        Ok(!leaves)
    }
}

impl Pending {
    const fn new(now: Instant) -> Self {
        Self { bytes: Vec::new(), since: now }
    }

    /// Goes on with what has arrived by now. Whether the server said goodbye.
    fn hear(
        &mut self,
        arrived: &[u8],
        now: Instant,
        session: &mut Session,
        outbox: &mut Outbox,
    ) -> std::result::Result<bool, Refusal> {
        if self.bytes.is_empty() {
            self.since = now;
        }
        self.bytes.extend(arrived);
        let heard = hear(session, &self.bytes, outbox)?;
        if heard.taken > 0 {
            self.bytes.drain(..heard.taken);
            self.since = now;
        }
        if !self.bytes.is_empty() && now.duration_since(self.since) > WHOLE {
            return Err(Refusal::Short);
        }
        Ok(heard.leaves)
    }
}

/// What there was among some bytes.
#[derive(Debug, PartialEq, Eq)]
struct Heard {
    /// Bytes of whole messages.
    taken: usize,
    /// Whether the server said goodbye.
    leaves: bool,
}

fn hear(session: &mut Session, bytes: &[u8], outbox: &mut Outbox) -> std::result::Result<Heard, Refusal> {
    let mut taken = 0;
    while let Some((message, length)) = wire::parse(&bytes[taken..])? {
        taken += length;
        if message.kind == wire::GOODBYE {
            return Ok(Heard { taken, leaves: true });
        }
        outbox.take(session.heard(&message));
    }
    Ok(Heard { taken, leaves: false })
}

#[cfg(test)]
#[path = "link_tests.rs"]
mod tests;
