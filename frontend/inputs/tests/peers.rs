//! Genuine peers over loopback: libvrpn, liblo, python-osc, and SMPTE's sender of OpenTrackIO.
//!
//! Those of PyPI are installed into a virtual environment among the test's own files. A peer that is missing is announced,
//! and is a failure with LIGHTLOOM_REQUIRE_PEERS=1.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod support;

use glam::{DQuat, DVec3};
use inputs::{DeviceTime, Event, Pose, What};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use support::vrpn_server::{DEVICE, Manner, POSITION, Server, TURN};
use support::{Asked, free_port, poses, skip};

/// Peers from PyPI, and what the first of them needs.
const PACKAGES: [&str; 3] = ["motioncapture==1.1", "numpy==2.2.6", "python-osc==1.10.2"];
/// What SMPTE's sender imports besides.
const SENDER_PACKAGES: [&str; 3] = ["cbor2==5.7.0", "jsonschema==4.25.1", "ntplib==0.4.0"];

/// A Python that has some packages; announced if there is none.
fn python(folder: &str, packages: &[&str]) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let (python, whole) = (folder.join("bin/python"), folder.join(packages.join(" ")));
    let run =
        |command: &mut Command| command.stdout(Stdio::null()).status().is_ok_and(|status| status.success());
    let has_all = whole.exists()
        || run(Command::new("python3").args(["-m", "venv"]).arg(&folder))
            && run(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(packages))
            && std::fs::write(&whole, "").is_ok();
    if !has_all {
        skip(&format!("python3 cannot make a virtual environment with {}", packages.join(", ")));
    }
    has_all.then_some(python)
}

fn peers() -> Option<PathBuf> {
    static PYTHON: OnceLock<Option<PathBuf>> = OnceLock::new();
    PYTHON.get_or_init(|| python("peers", &PACKAGES)).clone()
}

/// A process that ends with the test.
struct Peer(Child);

impl Peer {
    fn start(command: &mut Command) -> Self {
        Self(command.spawn().unwrap())
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Says what the genuine client gets: place and turn of the first pose of the device.
const VRPN_CLIENT: &str = "
import sys, motioncapture
client = motioncapture.connect('vrpn', {'hostname': sys.argv[1]})
while True:
    client.waitForNextFrame()
    for name, body in client.rigidBodies.items():
        if name == sys.argv[2] and any(body.position):
            turn = body.rotation
            print(*body.position, turn.x, turn.y, turn.z, turn.w, flush=True)
            sys.exit()
";

#[test]
fn the_genuine_vrpn_client_gets_what_our_server_sends() {
    let Some(python) = peers() else { return };
    for manner in [Manner::Modern, Manner::CallsBack] {
        let port = free_port();
        let _server = Server::start(port, manner);
        let host = format!("127.0.0.1:{port}");
        let mut client = Command::new(&python);
        let mut child =
            client.args(["-c", VRPN_CLIENT, &host, DEVICE]).stdout(Stdio::piped()).spawn().unwrap();
        let began = Instant::now();
        while child.try_wait().unwrap().is_none() {
            if began.elapsed() > support::PATIENCE {
                drop(Peer(child));
                panic!("the genuine client gets no pose from {manner:?}");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let output = child.wait_with_output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        let line = text.lines().last().unwrap_or_default();
        let numbers: Vec<f64> = line.split(' ').filter_map(|number| number.parse().ok()).collect();
        let [x, y, z, qx, qy, qz, qw] = numbers[..] else { panic!("{text}") };
        assert_eq!([x, y, z], POSITION);
        let (found, sent) = (DQuat::from_xyzw(qx, qy, qz, qw), DQuat::from_array(TURN));
        assert!((found - sent).length() < 1e-6, "{found} for {sent}");
        let w_first = DQuat::from_xyzw(TURN[3], TURN[0], TURN[1], TURN[2]);
        assert!((found - w_first).length() > 0.1, "the canary: another order shows");
        println!("{manner:?}: {line}, after {:.2} s", began.elapsed().as_secs_f64());
    }
}

fn osc(port: u16) -> Asked {
    let mut asked = Asked::new(&format!("[[input]]\nname = 'a'\nkind = 'osc'\nlisten = '127.0.0.1:{port}'"));
    asked.until("the port", |events| !events.is_empty());
    asked
}

fn has(what: What) -> impl Fn(&[Event]) -> bool {
    move |events| events.iter().any(|event| event.what == what)
}

#[test]
fn oscsend_is_heard() {
    let port = free_port();
    let mut asked = osc(port);
    let send = |message: &[&str]| {
        let status = Command::new("oscsend").args(["127.0.0.1", &port.to_string()]).args(message).status();
        status.is_ok_and(|status| status.success())
    };
    if !send(&["/lightloom/pose/4", "fffffff", "1", "-2", "3.5", "0.1", "-0.7", "0.5", "0.5"]) {
        return skip("oscsend, of Debian's liblo-tools, is not on the path");
    }
    assert!(send(&["/lightloom/button/1", "T"]) && send(&["/lightloom/axis/2", "d", "-0.25"]));
    assert!(send(&["/lightloom/lost/4"]));
    asked.until("a lost target", has(What::Pose { sensor: 4, pose: None }));
    asked.until("an axis", has(What::Axis { index: 2, value: -0.25 }));
    asked.until("a button", has(What::Button { index: 1, is_down: true }));
    let pose = asked.poses()[0];
    assert_eq!(pose.position_m(), DVec3::new(1.0, -2.0, 3.5));
    assert!((pose.rotation() - DQuat::from_xyzw(0.1, -0.7, 0.5, 0.5)).length() < 1e-7);
    assert_eq!(asked.hub.counts()[0].messages, 4);
}

/// Sends a bundle that was made a quarter of a second ago.
const OSC_BUNDLE: &str = "
import sys, time
from pythonosc import osc_bundle_builder, osc_message_builder, udp_client
bundle = osc_bundle_builder.OscBundleBuilder(time.time() - 0.25)
for address, numbers in [('/lightloom/pose/0', [1.0, 2.0, 3.0, 0.0, 0.0, 0.6, 0.8]), ('/lightloom/button/3', [1])]:
    message = osc_message_builder.OscMessageBuilder(address)
    for number in numbers:
        message.add_arg(number)
    bundle.add_content(message.build())
udp_client.UDPClient('127.0.0.1', int(sys.argv[1])).send(bundle.build())
";

#[test]
fn a_bundle_of_python_osc_says_when() {
    let Some(python) = peers() else { return };
    let port = free_port();
    let mut asked = osc(port);
    assert!(Command::new(python).args(["-c", OSC_BUNDLE, &port.to_string()]).status().unwrap().success());
    asked.until("a button", has(What::Button { index: 3, is_down: true }));
    let expected = Pose::new(DVec3::new(1.0, 2.0, 3.0), DQuat::from_xyzw(0.0, 0.0, 0.6, 0.8)).unwrap();
    assert!((asked.poses()[0].rotation() - expected.rotation()).length() < 1e-7);
    for event in &asked.events[1..] {
        let Some(DeviceTime::InStep(time)) = event.device_time else { panic!("{event:?}") };
        let age_s = event.received.as_secs_f64() - time.as_secs_f64();
        assert!((0.25..2.0).contains(&age_s), "{age_s} s");
    }
}

/// Sends samples of SMPTE's own sender, with a camera that stands still, to a port of this host.
const OPENTRACKIO: &str = "
import sys, time
sys.path.insert(0, sys.argv[1])
from opentrackio_sender import *
config = {'source_number': 1, 'port': 55555, 'multicast_group': '239.135.1.1', 'format': PayloadFormat[sys.argv[3]],
          'time_source': TimeSource.PTP, 'debug': False, 'num-segments': int(sys.argv[4])}
sender = OpenTrackIOPacketTransmitter(config)
sender._move_camera = lambda: {'x': 1.5, 'y': -2.0, 'z': 0.25, 'pan': 90.0, 'tilt': 30.0, 'roll': 0.0,
                               'focus': 0.1, 'iris': 0.2, 'zoom': 0.3}
target = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
while True:
    for segment in sender._create_opentrackio_packet():
        target.sendto(segment, ('127.0.0.1', int(sys.argv[2])))
    time.sleep(0.02)
";

/// The folder of the sender is named by LIGHTLOOM_OPENTRACKIO: no registry has it (`src/test/python/parser` of SMPTE's
/// repository ris-osvp-metadata-camdkit). So its lack is announced, and never a failure.
#[test]
fn smpte_s_sender_of_opentrackio_is_heard() {
    let Ok(sender) = std::env::var("LIGHTLOOM_OPENTRACKIO") else {
        return println!("SKIPPED: LIGHTLOOM_OPENTRACKIO does not name the folder of SMPTE's sender");
    };
    let Some(python) = python("opentrackio", &SENDER_PACKAGES) else { return };
    for (format, segments) in [("JSON", "0"), ("JSON", "5"), ("CBOR", "0"), ("CBOR", "3")] {
        let port = free_port();
        let mut asked =
            Asked::new(&format!("[[input]]\nname = 'a'\nkind = 'opentrackio'\nlisten = '127.0.0.1:{port}'"));
        let arguments = ["-c", OPENTRACKIO, &sender, &port.to_string(), format, segments];
        let _sender = Peer::start(Command::new(&python).args(arguments).stdout(Stdio::null()));
        asked.until("samples", |events| poses(events).len() >= 20);
        for pose in asked.poses() {
            assert_eq!(pose.position_m(), DVec3::new(1.5, -2.0, 0.25));
            let looks = pose.rotation() * DVec3::Y;
            assert!((looks - DVec3::new(-(3_f64.sqrt()) / 2.0, 0.0, 0.5)).length() < 1e-9, "{looks}");
        }
        let is_recent = |event: &Event| matches!(event.device_time, Some(DeviceTime::InStep(_)));
        assert!(asked.events.iter().any(is_recent));
        // The first sample may have begun before the port was open.
        let refused: u64 = asked.hub.counts()[0].refused.values().sum();
        assert!(refused <= 5, "{:?}", asked.hub.counts());
        println!("{format} in {segments} segments: {} poses, {refused} refused", asked.poses().len());
    }
}
