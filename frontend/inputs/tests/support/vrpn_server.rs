//! A small VRPN server, which the genuine client proves, and which then proves ours.

use inputs::vrpn::wire::{self, COOKIE, Message};
use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The device.
pub const DEVICE: &str = "Wand0";
/// Where its sensor 2 is, metres, and how it is turned (x, y, z, w): no two numbers are alike.
pub const POSITION: [f64; 3] = [0.25, -1.5, 3.125];
pub const TURN: [f64; 4] = [0.1, -0.7, 0.5, 0.5];
const TYPES: [&str; 3] = ["vrpn_Tracker Pos_Quat", "vrpn_Button Change", "vrpn_Analog Channel"];
const ANSWER: Duration = Duration::from_secs(2);

/// How a server behaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// Accepts connections and connects back.
    Modern,
    /// Only connects back.
    CallsBack,
    /// Sends the cookie of another version.
    Outdated,
    /// Sends so many bytes of its descriptions and a pose, then ends the connection.
    Cut(usize),
}

/// A server that runs until it is dropped.
pub struct Server {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    pub fn start(port: u16, manner: Manner) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let calls = UdpSocket::bind((Ipv4Addr::LOCALHOST, port)).unwrap();
        calls.set_read_timeout(Some(Duration::from_millis(5))).unwrap();
        let listener = (manner != Manner::CallsBack).then(|| listen(port));
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            let mut clients = Vec::new();
            while !stopped.load(Ordering::Relaxed) {
                let accepted =
                    listener.as_ref().and_then(|listener| listener.accept().ok()).map(|client| client.0);
                if let Some(stream) = accepted.or_else(|| called(&calls)) {
                    let stopped = Arc::clone(&stopped);
                    clients.push(std::thread::spawn(move || serve(stream, manner, &stopped)));
                }
            }
            clients.into_iter().for_each(|client| client.join().unwrap());
        });
        Self { stop, thread: Some(thread) }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap();
    }
}

fn listen(port: u16) -> TcpListener {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).unwrap();
    listener.set_nonblocking(true).unwrap();
    listener
}

/// A connection to whoever asks for one: "HOST PORT" and a zero byte.
fn called(calls: &UdpSocket) -> Option<TcpStream> {
    let mut bytes = [0; 256];
    let (length, _) = calls.recv_from(&mut bytes).ok()?;
    let text = std::str::from_utf8(bytes[..length].strip_suffix(&[0])?).ok()?;
    let (host, port) = text.split_once(' ')?;
    TcpStream::connect(SocketAddr::new(host.parse().ok()?, port.parse().ok()?)).ok()
}

fn message(sender: i32, kind: i32, payload: &[u8]) -> Vec<u8> {
    let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    wire::write(&Message { time, sender, kind, payload }, 0)
}

fn described(kind: i32, number: i32, name: &str) -> Vec<u8> {
    message(number, kind, &[&(name.len() as u32 + 1).to_be_bytes()[..], name.as_bytes(), &[0]].concat())
}

/// The names of the device and of the types, each by its number.
fn descriptions() -> Vec<u8> {
    let types = TYPES.iter().zip(0..).flat_map(|(name, number)| described(wire::TYPE, number, name));
    described(wire::SENDER, 0, "Other")
        .into_iter()
        .chain(described(wire::SENDER, 1, DEVICE))
        .chain(types)
        .collect()
}

pub fn pose() -> Vec<u8> {
    let numbers = POSITION.iter().chain(&TURN).flat_map(|number| number.to_be_bytes());
    message(1, 0, &[0, 0, 0, 2, 0, 0, 0, 0].into_iter().chain(numbers).collect::<Vec<u8>>())
}

/// Button 3 goes down and up, and two channels of which one moves.
fn others(round: u32) -> Vec<u8> {
    let is_down = u32::from(round % 10 < 5);
    let button = [3_u32.to_be_bytes(), is_down.to_be_bytes()].concat();
    let channels = [2.0, 0.25, f64::from(round % 100) / 100.0].map(f64::to_be_bytes).concat();
    [message(1, 1, &button), message(1, 2, &channels)].concat()
}

fn serve(mut stream: TcpStream, manner: Manner, stopped: &AtomicBool) {
    stream.set_nonblocking(false).unwrap();
    stream.set_read_timeout(Some(ANSWER)).unwrap();
    let cookie = if manner == Manner::Outdated { *b"vrpn: ver. 06.00  0\0\0\0\0\0" } else { COOKIE };
    let mut theirs = [0; COOKIE.len()];
    if stream.write_all(&cookie).and_then(|()| stream.read_exact(&mut theirs)).is_err() {
        return;
    }
    assert_eq!(theirs[..14], COOKIE[..14]);
    if let Manner::Cut(length) = manner {
        let bytes = [descriptions(), pose()].concat();
        let _ = stream.write_all(&bytes[..length.min(bytes.len())]);
        return;
    }
    let _ = stream.write_all(&descriptions());
    stream.set_read_timeout(Some(Duration::from_millis(1))).unwrap();
    let datagrams = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let (mut offered, mut heard) = (None, Vec::new());
    for round in 0.. {
        if stopped.load(Ordering::Relaxed) || !hears(&mut stream, &mut heard, &mut offered) {
            return;
        }
        // Trackers send by datagrams where a client takes them.
        let sent = match offered {
            Some(port) => datagrams.send_to(&pose(), (Ipv4Addr::LOCALHOST, port)).map(|_| ()),
            None => stream.write_all(&pose()),
        };
        if sent.and_then(|()| stream.write_all(&others(round))).is_err() {
            return;
        }
        std::thread::sleep(Duration::from_millis(4));
    }
}

/// Reads what a client says: the port at which it takes datagrams, if it does. Whether it is still there.
fn hears(stream: &mut TcpStream, heard: &mut Vec<u8>, offered: &mut Option<u16>) -> bool {
    let mut bytes = [0; 4096];
    match stream.read(&mut bytes) {
        Ok(0) => return false,
        Ok(count) => heard.extend(&bytes[..count]),
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
        Err(_) => return false,
    }
    while let Ok(Some((message, length))) = wire::parse(heard) {
        if message.kind == wire::UDP {
            *offered = u16::try_from(message.sender).ok();
        }
        heard.drain(..length);
    }
    true
}
