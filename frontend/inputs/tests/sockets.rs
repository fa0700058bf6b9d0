//! Sources over the sockets and pipes of this host.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod support;

use glam::{DQuat, DVec3};
use inputs::{Event, Pose, Refusal, SourceId, What};
use rosc::{OscMessage, OscPacket, OscType};
use rustix::net::sockopt::set_ip_multicast_if;
use std::io::Write;
use std::net::{Ipv4Addr, UdpSocket};
use std::os::unix::net::UnixListener;
use std::process::Command;
use std::time::{Duration, Instant};
use support::{Asked, free_port, poses};

const DTRACK: &str = "fr 1\nts 5.0\n6d 1 [3 1.000][100 -200 300 0 0 0][0 1 0 -1 0 0 0 0 1]\n6df2 1 1 [0 1.000 2 1][1 2 3]\
                      [1 0 0 0 1 0 0 0 1][2 0.50]\n";

fn sender() -> UdpSocket {
    UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap()
}

fn osc(address: &str, args: Vec<OscType>) -> Vec<u8> {
    rosc::encoder::encode(&OscPacket::Message(OscMessage { addr: address.to_owned(), args })).unwrap()
}

fn osc_pose(x: f32) -> Vec<u8> {
    osc("/lightloom/pose/1", [x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0].map(OscType::Float).into())
}

/// A camera 1 m along x that looks along y.
fn freed() -> Vec<u8> {
    let mut bytes = [&[0xd1, 9][..], &[0; 9], &[0, 0xfa, 0], &[0; 14]].concat();
    bytes.push(bytes.iter().fold(0x40, |rest: u8, byte| rest.wrapping_sub(*byte)));
    bytes
}

fn opentrackio() -> Vec<u8> {
    let sample =
        br#"{"transforms":[{"translation":{"x":1,"y":2,"z":3},"rotation":{"pan":90,"tilt":0,"roll":0}}]}"#;
    let mut bytes = [&b"OTrk\0\x01\0\0\0\0\0\0"[..], &(0x8000 | sample.len() as u16).to_be_bytes()].concat();
    let (first, second) = bytes.iter().chain(sample).fold((0_u8, 0_u8), |(first, second), byte| {
        let first = first.wrapping_add(*byte);
        (first, second.wrapping_add(first))
    });
    bytes.extend([second, first]);
    bytes.extend(sample);
    bytes
}

fn has_pose(events: &[Event]) -> bool {
    !poses(events).is_empty()
}

/// Sends a datagram again and again until it has arrived.
fn send_until_heard(asked: &mut Asked, port: u16, datagram: &[u8], is_enough: impl Fn(&[Event]) -> bool) {
    let (sender, began) = (sender(), Instant::now());
    while !is_enough(&asked.events) {
        assert!(began.elapsed() < support::PATIENCE, "{:?}", asked.hub.counts());
        sender.send_to(datagram, (Ipv4Addr::LOCALHOST, port)).unwrap();
        std::thread::sleep(Duration::from_millis(5));
        asked.poll();
    }
}

#[test]
fn each_protocol_is_heard_at_its_port() {
    let quarter = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    for (kind, datagram, position, turn) in [
        ("dtrack", DTRACK.as_bytes().to_vec(), DVec3::new(0.1, -0.2, 0.3), quarter),
        ("osc", osc_pose(7.0), DVec3::new(7.0, 0.0, 0.0), DQuat::IDENTITY),
        ("freed", freed(), DVec3::X, DQuat::IDENTITY),
        ("opentrackio", opentrackio(), DVec3::new(1.0, 2.0, 3.0), quarter),
    ] {
        let port = free_port();
        let mut asked =
            Asked::new(&format!("[[input]]\nname = 'a'\nkind = '{kind}'\nlisten = '127.0.0.1:{port}'"));
        send_until_heard(&mut asked, port, &datagram, has_pose);
        let expected = Pose::new(position, turn).unwrap();
        let found = asked.poses()[0];
        assert!((found.position_m() - position).length() < 1e-9, "{kind}: {found:?}");
        assert!((found.rotation() - expected.rotation()).length() < 1e-9, "{kind}: {found:?}");
        send_until_heard(&mut asked, port, b"garbage", |_| true);
        let garbage = Asked::poll;
        sender().send_to(b"garbage", (Ipv4Addr::LOCALHOST, port)).unwrap();
        let began = Instant::now();
        while asked.hub.counts()[0].refused.is_empty() {
            assert!(began.elapsed() < support::PATIENCE, "{kind}: garbage is not refused");
            garbage(&mut asked);
        }
    }
}

#[test]
fn a_group_is_joined() {
    let port = free_port();
    let mut asked =
        Asked::new(&format!("[[input]]\nname = 'a'\nkind = 'opentrackio'\nsource = 77\nport = {port}"));
    let sender = sender();
    set_ip_multicast_if(&sender, &Ipv4Addr::LOCALHOST).unwrap();
    let began = Instant::now();
    while !has_pose(&asked.events) {
        assert!(began.elapsed() < support::PATIENCE, "{:?}", asked.sentences());
        sender.send_to(&opentrackio(), (Ipv4Addr::new(239, 135, 1, 77), port)).unwrap();
        std::thread::sleep(Duration::from_millis(5));
        asked.poll();
    }
}

#[test]
fn a_silent_tracker_is_lost_lets_its_buttons_go_and_is_found_again() {
    let port = free_port();
    let mut asked =
        Asked::new(&format!("[[input]]\nname = 'a'\nkind = 'dtrack'\nlisten = '127.0.0.1:{port}'"));
    for _ in 0..2 {
        asked.events.clear();
        send_until_heard(&mut asked, port, DTRACK.as_bytes(), has_pose);
        asked.until("silence", |events| events.iter().any(|event| matches!(event.what, What::Lost(_))));
        let up = What::Button { index: 1, is_down: false };
        assert!(asked.events.iter().any(|event| event.what == up));
        assert_eq!(
            asked.sentences()[1],
            format!("nothing has arrived at 127.0.0.1:{port} for 2 s; it is listened to")
        );
    }
}

/// Sends poses as fast as that goes, a press or a release among 512 of them, and a release in the end. How many datagrams.
fn flood(port: u16, span: Duration) -> u64 {
    let (sender, began, mut sent) = (sender(), Instant::now(), 0_u64);
    let button = |is_down| osc("/lightloom/button/5", vec![OscType::Int(is_down)]);
    let (pose, down, up) = (osc_pose(1.0), button(1), button(0));
    while began.elapsed() < span {
        let datagram = match sent % 1024 {
            0 => &down,
            512 => &up,
            _ => &pose,
        };
        sent += u64::from(sender.send_to(datagram, (Ipv4Addr::LOCALHOST, port)).is_ok());
    }
    std::thread::sleep(Duration::from_millis(300));
    sender.send_to(&up, (Ipv4Addr::LOCALHOST, port)).unwrap();
    sent
}

/// A source sends as fast as it can, and is asked four times a second only; another goes on beside it.
#[test]
fn a_flood_is_bounded_and_starves_nobody() {
    let (flooded, calm) = (free_port(), free_port());
    let mut asked = Asked::new(&format!(
        "[[input]]\nname = 'flood'\nkind = 'osc'\nlisten = '127.0.0.1:{flooded}'\n\
         [[input]]\nname = 'calm'\nkind = 'freed'\nlisten = '127.0.0.1:{calm}'"
    ));
    send_until_heard(&mut asked, flooded, &osc_pose(0.0), has_pose);
    asked.events.clear();
    let began = Instant::now();
    let span = Duration::from_millis(1500);
    let flood = std::thread::spawn(move || flood(flooded, span));
    let (sender, mut sent) = (sender(), 0);
    while began.elapsed() < span {
        for _ in 0..25 {
            sent += sender.send_to(&freed(), (Ipv4Addr::LOCALHOST, calm)).map_or(0, |_| 1);
            std::thread::sleep(Duration::from_millis(10));
        }
        let (before, asking) = (asked.events.len(), Instant::now());
        asked.poll();
        assert!(asked.events.len() - before <= 2 * 4096, "what waits is bounded");
        assert!(
            asking.elapsed() < Duration::from_millis(500),
            "asking does not wait: {:?}",
            asking.elapsed()
        );
    }
    let flood_sent = flood.join().unwrap();
    asked.until("the last release", |events| {
        let last = events.iter().rev().find(|event| matches!(event.what, What::Button { .. }));
        last.is_some_and(|event| event.what == What::Button { index: 5, is_down: false })
    });
    let [flood, calm] = &asked.hub.counts()[..] else { panic!() };
    let rate = flood.messages as f64 / span.as_secs_f64();
    println!("{flood_sent} sent, {} heard ({rate:.0} a second), {} dropped", flood.messages, flood.dropped);
    assert!(flood.dropped > 0, "the canary: it is a flood");
    assert_eq!(calm.messages, sent, "the calm source loses nothing");
    let heard = asked
        .events
        .iter()
        .filter(|event| event.source == SourceId(1) && matches!(event.what, What::Pose { .. }));
    assert_eq!(heard.count() as u64, sent);
    assert!(flood.refused.is_empty());
}

#[test]
fn a_gamepad_is_read_and_looked_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("js0");
    let mut asked =
        Asked::new(&format!("[[input]]\nname = 'pad'\nkind = 'gamepad'\npath = '{}'", path.display()));
    asked.until("nothing there", |events| events.iter().any(|event| matches!(event.what, What::Lost(_))));
    assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
    // Both ends are open, so that the reader does not see an end before the first event.
    let mut pipe = std::fs::OpenOptions::new().read(true).write(true).open(&path).unwrap();
    let event = |value: i16, kind| [&7_u32.to_ne_bytes()[..], &value.to_ne_bytes(), &[kind, 3]].concat();
    let bytes = [event(1, 0x81), event(-32767, 2), event(0, 9)].concat();
    // Also in parts.
    pipe.write_all(&bytes[..11]).unwrap();
    std::thread::sleep(Duration::from_millis(20));
    pipe.write_all(&bytes[11..]).unwrap();
    asked.until("events", |events| {
        events.iter().any(|event| event.what == What::Axis { index: 3, value: -1.0 })
    });
    assert!(asked.events.iter().any(|event| event.what == What::Button { index: 3, is_down: true }));
    let began = Instant::now();
    while asked.hub.counts()[0].refused != [(Refusal::Form, 1)].into() {
        assert!(began.elapsed() < support::PATIENCE);
    }
}

#[test]
fn a_spacemouse_is_read_and_found_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("spnav.sock");
    let text = format!("[[input]]\nname = 'cap'\nkind = 'spacemouse'\npath = '{}'", path.display());
    let mut asked = Asked::new(&text);
    for _ in 0..2 {
        asked.events.clear();
        let _ = std::fs::remove_file(&path);
        let daemon = UnixListener::bind(&path).unwrap();
        let (mut stream, _) = daemon.accept().unwrap();
        let event = |numbers: [i32; 8]| numbers.map(i32::to_ne_bytes).concat();
        let events = [event([1, 2, 0, 0, 0, 0, 0, 0]), event([0, 0, 0, -175, 0, 0, 0, 16])].concat();
        stream.write_all(&events).unwrap();
        asked.until("motion", |events| {
            events.iter().any(|event| event.what == What::Axis { index: 2, value: -0.5 })
        });
        drop((stream, daemon));
        asked.until("the end", |events| matches!(events.last(), Some(Event { what: What::Lost(_), .. })));
        let whats: Vec<&What> = asked.events.iter().map(|event| &event.what).collect();
        assert!(whats.contains(&&What::Button { index: 2, is_down: false }));
        assert!(whats.contains(&&What::Axis { index: 2, value: 0.0 }), "axes come to rest");
    }
}

#[test]
fn a_port_that_is_taken_is_tried_again() {
    let taken = sender();
    let port = taken.local_addr().unwrap().port();
    let mut asked = Asked::new(&format!("[[input]]\nname = 'a'\nkind = 'osc'\nlisten = '127.0.0.1:{port}'"));
    asked.until("a sentence", |events| !events.is_empty());
    assert!(asked.sentences()[0].starts_with(&format!("cannot listen at 127.0.0.1:{port}: ")));
    drop(taken);
    send_until_heard(&mut asked, port, &osc_pose(0.0), has_pose);
}
