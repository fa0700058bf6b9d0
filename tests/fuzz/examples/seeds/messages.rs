//! Seeds of the targets that read messages: packets of inputs, the wire between processes, tapes.

use glam::{DAffine3, DVec3};
use inputs::vrpn::wire as vrpn;
use inputs::{DeviceTime, Event, Pose, SourceId, What};
use lightloom_fuzz::protocols::Protocol;
use optics::{Curve, Optics};
use protocol::wire::{WireMessage, encode};
use protocol::{FrameState, FromBackend, FromFrontend, Mark, MarkShape, Paint, ScreenImage, SubFrame};
use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Duration;
use tape::{AttachedFile, Frame, Head, Limits, Record, Writer};
use world::{Deed, Moment};

/// A message of every protocol of inputs.
pub fn packets(out: &Path) -> Result<(), Box<dyn Error>> {
    let dtrack = "fr 1\nts 5.0\n6d 2 [0 1.000][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1] [1 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1]\n\
                  6df2 1 1 [0 1.000 6 2][1 2 3][1 0 0 0 1 0 0 0 1][2 0.5 -1]\n\
                  6dmt2 1 1 [0 1.0 4 2.0][1 2 3][1 0 0 0 1 0 0 0 1][5][1 2 3 4 5 6]\n";
    let json = r#"{"transforms":[{"translation":{"x":1,"y":2,"z":3},"rotation":{"pan":9,"tilt":0,"roll":0},"id":"a"}],
                   "timing":{"sampleTimestamp":{"seconds":1,"nanoseconds":5}}}"#;
    let mut cbor = Vec::new();
    ciborium::into_writer(&serde_json::from_str::<serde_json::Value>(json)?, &mut cbor)?;
    let segment = [b"OTrk\0\x01\0\x05\0\0\0\0\x80\x07\0\0".to_vec(), b"{\"a\":1}".to_vec()].concat();
    let osc = b"#bundle\0\0\0\0\0\0\0\0\x01\0\0\0\x14/a/pose/1\0\0\0,ff\0\0\0\0\0\x3f\x80\0\0";
    for (number, protocol) in (0_u8..).zip(Protocol::ALL) {
        let bytes = match protocol {
            Protocol::Dtrack => dtrack.into(),
            Protocol::OpenTrackIo => segment.clone(),
            Protocol::Json => json.into(),
            Protocol::Cbor => cbor.clone(),
            Protocol::Osc => osc.to_vec(),
            Protocol::FreeD => vec![0xd1; 29],
            Protocol::Gamepad => vec![1; 8],
            Protocol::SpaceMouse => [1, 0, 0, 0].repeat(8),
            Protocol::Vrpn => vrpn_messages(),
        };
        fs::write(out.join(format!("{protocol:?}")), [vec![number], bytes].concat())?;
    }
    Ok(())
}

/// A device, types, and a message of each.
fn vrpn_messages() -> Vec<u8> {
    let time = Duration::from_secs(1);
    let message =
        |sender, kind, payload: &[u8]| vrpn::write(&vrpn::Message { time, sender, kind, payload }, 0);
    let named = |name: &str| [&(name.len() as u32 + 1).to_be_bytes()[..], name.as_bytes(), &[0]].concat();
    let types = ["vrpn_Tracker Pos_Quat", "vrpn_Button States", "vrpn_Analog Channel"];
    let types = types.iter().zip(1..).map(|(name, number)| message(number, vrpn::TYPE, &named(name)));
    let said = [&[0; 64][..], &[0, 0, 0, 1, 0, 0, 0, 1], &[0; 8]];
    let said = said.iter().zip(1..).map(|(payload, kind)| message(1, kind, payload));
    [message(1, vrpn::SENDER, &named("Wand"))].into_iter().chain(types).chain(said).flatten().collect()
}

/// Messages in both directions.
pub fn wire(out: &Path) -> Result<(), Box<dyn Error>> {
    let optics = Optics::grey(Curve::constant(1.0));
    let still = FrameState::still(DVec3::Z, DAffine3::IDENTITY, optics);
    let paint = Paint { rgb: [1.0, 0.5, 0.0], opacity: 0.5 };
    let shape = MarkShape::Stroke { points_in_display: vec![DVec3::X, DVec3::Y], radius_m: 0.01 };
    let marked =
        FrameState { sub_frame: Some(SubFrame::Right), marks: vec![Mark { shape, paint }], ..still.clone() };
    let picture = ScreenImage { projector: 1, width: 2, height: 1, rgb: vec![1, 2, 3, 4, 5, 6] };
    let frontend = [
        FromFrontend::Frame(Box::new(still.clone())),
        FromFrontend::Beat { newest: Some(Box::new(still.clone())), frame: Box::new(marked) },
        FromFrontend::Show { frame: 7, at_us: Some(9) },
        FromFrontend::Clock { asked_us: 5 },
        FromFrontend::Quit,
    ];
    let backend = [
        FromBackend::Screen(picture),
        FromBackend::Shown { frame: 7, at_us: 9 },
        FromBackend::Failed("it broke".to_owned()),
        FromBackend::Alive,
    ];
    write(out, "frontend", 0, &frontend)?;
    write(out, "backend", 1, &backend)
}

fn write<M: WireMessage>(out: &Path, name: &str, side: u8, messages: &[M]) -> Result<(), Box<dyn Error>> {
    for (number, message) in messages.iter().enumerate() {
        fs::write(out.join(format!("{name}_{number}")), [vec![side], encode(message)?].concat())?;
    }
    Ok(())
}

/// A tape of a second, whole and cut short.
pub fn tapes(out: &Path) -> Result<(), Box<dyn Error>> {
    let head = Head {
        show: "open day".to_owned(),
        version: "0.1.0".to_owned(),
        began_ns: 1_800_000_000_000_000_000,
        sources: vec!["wand".to_owned()],
        settings: [("display".to_owned(), "desk8".to_owned())].into(),
        files: vec![AttachedFile { name: "scene.toml".to_owned(), bytes: b"[volume]\n".to_vec() }],
        part: 1,
    };
    let path = out.join("whole");
    let mut writer = Writer::create(&path, head, Limits::default())?;
    for number in 0..30_u32 {
        let now = Duration::from_millis(33) * number;
        let pose = Pose::new(DVec3::new(f64::from(number), 0.0, 1.0), glam::DQuat::IDENTITY);
        let what = What::Pose { sensor: 3, pose };
        let event =
            Event { source: SourceId(0), device_time: Some(DeviceTime::Own(now)), received: now, what };
        writer.write(now, Record::Deed(Deed::Event(event)));
        writer.write(now, Record::Frame(Frame::new(number, Moment { now, seen_at: now }, 7)));
    }
    writer.finish()?;
    let bytes = fs::read(&path)?;
    Ok(fs::write(out.join("cut"), &bytes[..bytes.len() * 2 / 3])?)
}
