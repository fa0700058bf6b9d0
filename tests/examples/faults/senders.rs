//! Wands that say where they are, and are made to fail.

use super::packets::{self, DEVICE, DURING_M};
use inputs::vrpn::wire::COOKIE;
use lightloom_tests::random::Random;
use std::io::Write;
use std::net::{Ipv4Addr, TcpListener, TcpStream, UdpSocket};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{JoinHandle, sleep};
use std::time::Duration;

/// From one thing that is sent to the next.
const INTERVAL: Duration = Duration::from_millis(10);
/// In that time, of a flood of 10⁵ a second.
const FLOOD: usize = 1000;

/// Who speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Dtrack,
    Osc,
    Vrpn,
}

/// All there are.
pub const KINDS: [Kind; 3] = [Kind::Dtrack, Kind::Osc, Kind::Vrpn];

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Self::Dtrack => "dtrack",
            Self::Osc => "osc",
            Self::Vrpn => "vrpn",
        }
    }

    /// Its entry in a file of inputs.
    pub fn entry(self, port: u16) -> String {
        let name = self.name();
        let place = match self {
            Self::Dtrack | Self::Osc => format!("listen = '127.0.0.1:{port}'"),
            Self::Vrpn => format!("address = '127.0.0.1:{port}'\ndevice = '{DEVICE}'"),
        };
        format!("[[input]]\nname = '{name}'\nkind = '{name}'\n{place}\n")
    }

    fn packet(self, x_m: f64, count: u64) -> Vec<u8> {
        match self {
            Self::Dtrack => packets::dtrack(x_m, count),
            Self::Osc => packets::osc(x_m),
            Self::Vrpn => packets::vrpn(x_m),
        }
    }
}

/// How a source fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Not at all.
    None,
    /// It is gone, and its sockets are.
    Killed,
    /// A few bytes of all that it sends are others, and some are missing.
    Garbled,
    /// It sends 10⁵ a second.
    Flooded,
    /// It says nothing.
    Paused,
}

impl Fault {
    /// All there are.
    pub const ALL: [Self; 5] = [Self::None, Self::Killed, Self::Garbled, Self::Flooded, Self::Paused];

    pub fn name(self) -> &'static str {
        match self {
            Self::None => "well",
            Self::Killed => "killed",
            Self::Garbled => "garbled",
            Self::Flooded => "flooded",
            Self::Paused => "paused",
        }
    }
}

/// What a sender does at present.
#[derive(Clone, Copy, Debug)]
enum Order {
    Send { fault: Fault, x_m: f64 },
    End,
}

/// A source, in a thread; dropped, it ends.
pub struct Sender {
    order: Arc<Mutex<Order>>,
    thread: Option<JoinHandle<()>>,
}

impl Sender {
    pub fn start(kind: Kind, port: u16) -> Self {
        let order = Arc::new(Mutex::new(Order::Send { fault: Fault::None, x_m: DURING_M }));
        let own = Arc::clone(&order);
        let thread = Some(std::thread::spawn(move || send(kind, port, &own)));
        Self { order, thread }
    }

    /// From now on it fails.
    pub fn suffer(&self, fault: Fault) {
        self.obey(Order::Send { fault, x_m: DURING_M });
    }

    /// From now on it is well, and where it is after a schedule.
    pub fn recover(&self, schedule: u32) {
        self.obey(Order::Send { fault: Fault::None, x_m: packets::place_m(schedule) });
    }

    fn obey(&self, order: Order) {
        *self.order.lock().unwrap_or_else(PoisonError::into_inner) = order;
    }
}

impl Drop for Sender {
    fn drop(&mut self) {
        self.obey(Order::End);
        if let Some(thread) = self.thread.take() {
            // What a sender says is for the other end alone.
            let _ = thread.join();
        }
    }
}

static SEED: AtomicU64 = AtomicU64::new(1);

fn send(kind: Kind, port: u16, order: &Mutex<Order>) {
    let mut random = Random(SEED.fetch_add(1, Ordering::Relaxed));
    let mut mouth = None;
    for count in 0.. {
        let now = *order.lock().unwrap_or_else(PoisonError::into_inner);
        let Order::Send { fault, x_m } = now else { return };
        if fault == Fault::Killed {
            mouth = None;
        } else if fault != Fault::Paused {
            let mouth = mouth.get_or_insert_with(|| Mouth::open(kind, port));
            for _ in 0..if fault == Fault::Flooded { FLOOD } else { 1 } {
                let mut packet = kind.packet(x_m, count);
                if fault == Fault::Garbled {
                    garble(&mut packet, &mut random);
                }
                mouth.say(&packet);
            }
        }
        sleep(INTERVAL);
    }
}

/// Changes up to four bytes, and cuts one packet in four.
fn garble(packet: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(packet.len() as u64) as usize;
        packet[at] = random.below(256) as u8;
    }
    if random.below(4) == 0 {
        packet.truncate(random.below(packet.len() as u64) as usize);
    }
}

/// The socket that a source speaks by.
enum Mouth {
    Datagrams { socket: Option<UdpSocket>, port: u16 },
    Server { listener: Option<TcpListener>, clients: Vec<TcpStream> },
}

impl Mouth {
    fn open(kind: Kind, port: u16) -> Self {
        match kind {
            Kind::Dtrack | Kind::Osc => {
                Self::Datagrams { socket: UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).ok(), port }
            }
            Kind::Vrpn => {
                // None while the port is not free again; the next one is opened after the next end.
                let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).ok();
                if let Some(listener) = &listener {
                    let _ = listener.set_nonblocking(true);
                }
                Self::Server { listener, clients: Vec::new() }
            }
        }
    }

    /// Nobody may listen, or not keep up: then it is lost.
    fn say(&mut self, packet: &[u8]) {
        match self {
            Self::Datagrams { socket, port } => {
                let _ = socket.as_ref().map(|socket| socket.send_to(packet, (Ipv4Addr::LOCALHOST, *port)));
            }
            Self::Server { listener, clients } => {
                if let Some(Ok((mut client, _))) = listener.as_ref().map(TcpListener::accept) {
                    let greeted = client
                        .set_nonblocking(false)
                        .and_then(|()| client.set_write_timeout(Some(INTERVAL)))
                        .and_then(|()| client.write_all(&COOKIE))
                        .and_then(|()| client.write_all(&packets::vrpn_descriptions()));
                    if greeted.is_ok() {
                        clients.push(client);
                    }
                }
                clients.retain_mut(|client| client.write_all(packet).is_ok());
            }
        }
    }
}
