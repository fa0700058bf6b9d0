//! Seeds of the targets that read messages: packets of inputs, the wire between processes, tapes.

use glam::{DAffine3, DVec3};
use inputs::{DeviceTime, Event, Pose, SourceId, What};
use lightloom_fuzz::protocols::{PROTOCOLS, Protocol};
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
    for (number, Protocol { name, seed, .. }) in (0_u8..).zip(PROTOCOLS) {
        fs::write(out.join(name), [vec![number], seed()].concat())?;
    }
    Ok(())
}

/// Messages in both directions.
pub fn wire(out: &Path) -> Result<(), Box<dyn Error>> {
    let optics = Optics::grey(Curve::constant(1.0));
    let still = FrameState::still(DVec3::Z, DAffine3::IDENTITY, optics);
    let paint = Paint { rgb: [1.0, 0.5, 0.0], opacity: 0.5 };
    let shape = MarkShape::Stroke { points_in_display: vec![DVec3::X, DVec3::Y], radius_m: 0.01 };
    let marks = vec![Mark { shape, paint, is_depth_combined: true }];
    let marked = FrameState { sub_frame: Some(SubFrame::Right), marks, ..still.clone() };
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

/// A tape of a second: whole, cut short, and without chunks, whose checksums keep changes from what is in them.
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
    fs::write(out.join("cut"), &bytes[..bytes.len() * 2 / 3])?;
    Ok(fs::write(out.join("flat"), without_chunks(&bytes)?)?)
}

/// The records of a tape in one row. A record is its kind, its length in eight bytes, and its body.
fn without_chunks(bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    /// The kinds of a chunk, and of the record that ends a file, before its last signature.
    const CHUNK: u8 = 6;
    const FOOTER: u8 = 2;
    /// A chunk's bytes before its packed records.
    const CHUNK_HEAD_BYTES: usize = 44;
    let (signature, mut rest) = bytes.split_at_checked(8).ok_or("a tape has a signature")?;
    let mut flat = signature.to_vec();
    while let Some(([kind, length @ ..], body)) = rest.split_first_chunk::<9>() {
        let length = u64::from_le_bytes(*length) as usize;
        if *kind == CHUNK {
            flat.extend(zstd::decode_all(&body[CHUNK_HEAD_BYTES..length])?);
        } else {
            flat.extend(&rest[..9 + length]);
        }
        rest = &body[length..];
        if *kind == FOOTER {
            break;
        }
    }
    flat.extend(rest);
    Ok(flat)
}
