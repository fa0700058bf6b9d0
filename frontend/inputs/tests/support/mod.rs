//! What the tests of sources share: a hub that is asked until something has happened, and ports that are free.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub mod vrpn_server;

use inputs::{Event, Hub, Input, Pose, What};
use std::net::{Ipv4Addr, TcpListener, UdpSocket};
use std::path::Path;
use std::time::{Duration, Instant};

/// No source takes longer to say what a test waits for.
pub const PATIENCE: Duration = Duration::from_secs(20);

/// What the clock shows when a hub is first asked: what was measured before has a time, too.
const BEGINNING: Duration = Duration::from_secs(100);

/// A hub and the clock that it is asked by.
pub struct Asked {
    pub hub: Hub,
    began: Instant,
    pub events: Vec<Event>,
}

impl Asked {
    /// Of the entries of a file.
    pub fn new(text: &str) -> Self {
        let inputs = Input::from_toml(Path::new(""), text, "test.toml").unwrap();
        Self { hub: Hub::start(&inputs).unwrap(), began: Instant::now(), events: Vec::new() }
    }

    pub fn poll(&mut self) {
        self.hub.poll(BEGINNING + self.began.elapsed(), &mut self.events);
    }

    /// Asks until what has happened is enough; what there is otherwise goes into the panic.
    pub fn until(&mut self, what: &str, is_enough: impl Fn(&[Event]) -> bool) {
        let began = Instant::now();
        while !is_enough(&self.events) {
            assert!(began.elapsed() < PATIENCE, "{what}: {:?} {:?}", self.events.last(), self.hub.counts());
            std::thread::sleep(Duration::from_millis(2));
            self.poll();
        }
    }

    pub fn poses(&self) -> Vec<Pose> {
        poses(&self.events)
    }

    /// The sentences about sources.
    pub fn sentences(&self) -> Vec<String> {
        let sentence = |event: &Event| match &event.what {
            What::Found(sentence) | What::Lost(sentence) => Some(sentence.clone()),
            _ => None,
        };
        self.events.iter().filter_map(sentence).collect()
    }
}

pub fn poses(events: &[Event]) -> Vec<Pose> {
    let pose = |event: &Event| match event.what {
        What::Pose { pose, .. } => pose,
        _ => None,
    };
    events.iter().filter_map(pose).collect()
}

/// A port of this host that nothing listens at, neither to datagrams nor to connections.
pub fn free_port() -> u16 {
    loop {
        let port = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port();
        if TcpListener::bind((Ipv4Addr::LOCALHOST, port)).is_ok() {
            return port;
        }
    }
}

/// Says aloud that a peer is missing; a failure where the environment forbids it.
pub fn skip(lack: &str) {
    println!("SKIPPED: {lack}");
    assert!(
        std::env::var("LIGHTLOOM_REQUIRE_PEERS").as_deref() != Ok("1"),
        "LIGHTLOOM_REQUIRE_PEERS=1, and {lack}"
    );
}
