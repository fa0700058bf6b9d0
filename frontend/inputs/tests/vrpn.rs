//! Our VRPN client against the server of these tests, which the genuine client proves in `peers`.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod support;

use glam::{DQuat, DVec3};
use inputs::{DeviceTime, Event, Pose, Refusal, What};
use std::time::{Duration, Instant};
use support::vrpn_server::{DEVICE, Manner, POSITION, Server, TURN};
use support::{Asked, free_port, poses};

fn client(port: u16, more: &str) -> Asked {
    Asked::new(&format!(
        "[[input]]\nname = 'wand'\nkind = 'vrpn'\naddress = '127.0.0.1:{port}'\ndevice = '{DEVICE}'\n{more}"
    ))
}

fn expected() -> Pose {
    Pose::new(DVec3::from_array(POSITION), DQuat::from_array(TURN)).unwrap()
}

fn has_poses(count: usize) -> impl Fn(&[Event]) -> bool {
    move |events| poses(events).len() >= count
}

#[test]
fn poses_buttons_and_channels_arrive_whichever_way_the_server_connects() {
    for (manner, more) in [
        (Manner::Modern, ""),
        (Manner::CallsBack, ""),
        (Manner::Modern, "udp = true"),
        (Manner::CallsBack, "udp = true"),
    ] {
        let port = free_port();
        let _server = Server::start(port, manner);
        let mut asked = client(port, more);
        asked.until("poses", has_poses(20));
        assert!(asked.poses().iter().all(|pose| *pose == expected()), "{manner:?} {more}");
        let is_button = |is_down| move |event: &Event| event.what == What::Button { index: 3, is_down };
        asked.until("buttons", |events| [true, false].iter().all(|&down| events.iter().any(is_button(down))));
        asked.until("axes", |events| {
            events.iter().any(|event| event.what == What::Axis { index: 0, value: 0.25 })
        });
        let age = asked.events.iter().find_map(|event| match event.device_time {
            Some(DeviceTime::InStep(time)) => Some(event.received.as_secs_f64() - time.as_secs_f64()),
            _ => None,
        });
        assert!((-0.1..1.0).contains(&age.unwrap()), "{age:?}");
        assert_eq!(asked.sentences(), [format!("`{DEVICE}` is heard from 127.0.0.1:{port}")]);
    }
}

#[test]
fn a_server_that_is_killed_is_found_again() {
    let port = free_port();
    let mut asked = client(port, "");
    let lost = |events: &[Event]| matches!(events.last(), Some(Event { what: What::Lost(_), .. }));
    asked.until("a server that is not there yet", lost);
    for _ in 0..2 {
        asked.events.clear();
        let server = Server::start(port, Manner::Modern);
        let began = Instant::now();
        asked.until("poses", has_poses(3));
        println!("found after {:.2} s", began.elapsed().as_secs_f64());
        drop(server);
        asked.until("the end", |events| events.iter().any(|event| matches!(event.what, What::Lost(_))));
        let let_go = What::Pose { sensor: 2, pose: None };
        assert!(asked.events.iter().any(|event| event.what == let_go), "a lost source has no targets");
        assert_eq!(asked.sentences().len(), 2, "{:?}", asked.sentences());
    }
}

#[test]
fn servers_of_another_version_and_without_the_device_are_named() {
    let port = free_port();
    let server = Server::start(port, Manner::Outdated);
    let mut asked = client(port, "");
    asked.until("a sentence", |events| !events.is_empty());
    let sentence = &asked.sentences()[0];
    assert!(sentence.contains("its cookie is refused, it is of another protocol or version"), "{sentence}");
    drop(server);
    let _server = Server::start(port, Manner::Modern);
    let mut asked = Asked::new(&format!(
        "[[input]]\nname = 'wand'\nkind = 'vrpn'\naddress = '127.0.0.1:{port}'\ndevice = 'Wnd0'"
    ));
    asked.until("a sentence", |events| !events.is_empty());
    let sentence = &asked.sentences()[0];
    assert!(sentence.ends_with("has no device `Wnd0`; check its name at the server"), "{sentence}");
}

#[test]
fn conversations_that_are_cut_end_in_a_sentence_and_give_no_pose() {
    for length in [0, 3, 24, 60, 200, 300] {
        let port = free_port();
        let _server = Server::start(port, Manner::Cut(length));
        let mut asked = client(port, "");
        asked.until("the end", |events| events.iter().any(|event| matches!(event.what, What::Lost(_))));
        assert_eq!(asked.poses(), [], "{length}");
    }
}

#[test]
fn a_server_that_is_none_is_refused() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let mut asked = client(port, "");
    let (mut stream, _) = listener.accept().unwrap();
    let garbage = [&inputs::vrpn::wire::COOKIE[..], &[0xff; 64]].concat();
    std::io::Write::write_all(&mut stream, &garbage).unwrap();
    asked.until("a sentence", |events| !events.is_empty());
    assert!(asked.sentences()[0].contains("a message is refused"), "{:?}", asked.sentences());
    assert_eq!(asked.hub.counts()[0].refused, [(Refusal::Long, 1)].into());
    std::thread::sleep(Duration::from_millis(1));
}
