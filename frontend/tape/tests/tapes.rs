//! Tapes as files: what is written is read, whatever becomes of the file.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

use glam::{DQuat, DVec3};
use inputs::{DeviceTime, Event, Pose, SourceId, What};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tape::{
    AttachedFile, Ending, Format, Frame, Head, Limits, Record, Said, Tape, TapeError, Writer, cut, export,
    info,
};
use world::{Change, Deed, Moment};

fn head() -> Head {
    Head {
        show: "open day".to_owned(),
        version: "0.1.0".to_owned(),
        began_ns: 1_800_000_000_000_000_000,
        sources: vec!["wand".to_owned(), "ball \"two\"".to_owned()],
        settings: [("display".to_owned(), "desk8".to_owned())].into(),
        files: vec![AttachedFile { name: "scene.toml".to_owned(), bytes: b"[volume]\n".to_vec() }],
        part: 1,
    }
}

fn frame(number: u32, now: Duration) -> Record {
    let moment = Moment { now, seen_at: now + Duration::from_millis(33) };
    Record::Frame(Frame::new(number, moment, 0xfedc_ba98_7654_3210 ^ u64::from(number)))
}

fn pose(now: Duration, x: f64) -> Record {
    let pose = Pose::new(
        DVec3::new(x, -0.0, f64::MIN_POSITIVE / 3.0),
        DQuat::from_xyzw(0.1, 0.7, -0.5, 0.5).normalize(),
    );
    let what = What::Pose { sensor: 3, pose };
    let device_time = Some(DeviceTime::Own(now));
    Record::Deed(Deed::Event(Event { source: SourceId(1), device_time, received: now, what }))
}

/// Some seconds of a show at 60 Hz, and when each record came.
fn show(seconds: f64) -> Vec<(Duration, Record)> {
    let frames = (60.0 * seconds) as u32;
    let each = (0..frames).flat_map(|number| {
        let now = Duration::from_secs(1) + Duration::from_secs_f64(f64::from(number) / 60.0);
        let click = What::Button { index: 1, is_down: number % 50 < 25 };
        let click = Event { source: SourceId(0), device_time: None, received: now, what: click };
        let mut records = vec![pose(now, f64::from(number).sqrt() / 7.0)];
        records.extend((number % 25 == 0).then_some(Record::Deed(Deed::Event(click))));
        records.push(frame(number, now));
        records.into_iter().map(move |record| (now, record))
    });
    each.collect()
}

fn write(path: &Path, records: &[(Duration, Record)]) {
    let mut writer = Writer::create(path, head(), Limits::default()).unwrap();
    for chunk in records.chunks(4000) {
        chunk.iter().for_each(|(now, record)| writer.write(*now, record.clone()));
        // Nobody records faster than disks write; a test does.
        std::thread::sleep(Duration::from_millis(100));
    }
    writer.finish().unwrap();
}

/// What is read before the end, and how that is.
fn read(path: &Path) -> Result<(Vec<Record>, Option<String>), TapeError> {
    let (mut records, mut ending) = (Vec::new(), None);
    for record in Tape::open(path)?.records() {
        match record {
            Ok(record) => records.push(record),
            Err(error) => ending = Some(error.to_string()),
        }
    }
    Ok((records, ending))
}

fn only_records(show: &[(Duration, Record)]) -> Vec<Record> {
    show.iter().map(|(_, record)| record.clone()).collect()
}

fn number() -> impl Strategy<Value = f64> {
    any::<f64>().prop_filter("finite", |number| number.is_finite() && number.abs() < 1e6)
}

fn deeds() -> impl Strategy<Value = Deed> {
    let pose =
        (any::<u8>(), proptest::option::of([number(), number(), number()])).prop_map(|(sensor, at)| {
            let turn = DQuat::from_xyzw(0.3, -0.1, 0.2, 0.9).normalize();
            What::Pose { sensor, pose: at.and_then(|at| Pose::new(DVec3::from_array(at), turn)) }
        });
    let what = prop_oneof![
        pose,
        (any::<u8>(), any::<bool>()).prop_map(|(index, is_down)| What::Button { index, is_down }),
        (any::<u8>(), number()).prop_map(|(index, value)| What::Axis { index, value }),
        "\\PC*".prop_map(What::Found),
        ".*".prop_map(What::Lost),
    ];
    let time = || (0..1_u64 << 60).prop_map(Duration::from_nanos);
    let device = prop_oneof![time().prop_map(DeviceTime::InStep), time().prop_map(DeviceTime::Own)];
    let event = (0..2_u16, proptest::option::of(device), time(), what).prop_map(
        |(source, device_time, received, what)| {
            Deed::Event(Event { source: SourceId(source), device_time, received, what })
        },
    );
    let change = prop_oneof![
        (number(), number()).prop_map(|(right, down)| Change::Turn { right, down }),
        [number(), number(), number()].prop_map(|by| Change::Move(DVec3::from_array(by))),
        number().prop_map(Change::Scale),
        number().prop_map(Change::MoveClip),
        Just(Change::Clip),
        Just(Change::NextLook),
        Just(Change::NextItem),
        Just(Change::Pause),
        Just(Change::Reset),
    ];
    prop_oneof![3 => event, 1 => change.prop_map(Deed::Change)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_to_the_bit(deeds in prop::collection::vec(deeds(), 0..60)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("day.mcap");
        let mut records: Vec<Record> = deeds.into_iter().map(Record::Deed).collect();
        records.push(frame(7, Duration::from_nanos(123_456_789)));
        records.push(Record::Said(Said { now_ns: 5, text: "a\u{0}b\n\"c\"".to_owned() }));
        write(&path, &records.iter().map(|record| (Duration::from_millis(1), record.clone())).collect::<Vec<_>>());
        let tape = Tape::open(&path).unwrap();
        prop_assert_eq!(tape.head(), &head());
        // Debug tells −0 from 0.
        let found: Vec<Record> = tape.records().map(Result::unwrap).collect();
        prop_assert_eq!(format!("{found:?}"), format!("{records:?}"));
    }
}

/// A tape cut at every byte of its last seconds has all that was flushed before, or says why not.
#[test]
fn a_tape_that_is_cut_anywhere_has_all_but_its_last_second() {
    let folder = tempfile::tempdir().unwrap();
    let (path, part) = (folder.path().join("day.mcap"), folder.path().join("part.mcap"));
    let show = show(5.0);
    write(&path, &show);
    let (bytes, records) = (std::fs::read(&path).unwrap(), only_records(&show));
    assert_eq!(read(&path).unwrap(), (records.clone(), None));
    let mut longest = 0;
    for end in bytes.len() / 2..bytes.len() {
        std::fs::write(&part, &bytes[..end]).unwrap();
        let (found, ending) = read(&part).unwrap();
        assert_eq!(found, records[..found.len()], "cut at {end}");
        assert!(ending.is_some() || found.len() == records.len(), "cut at {end}: what is missing is told");
        assert!(found.len() >= longest, "cut at {end}: more bytes, and fewer records");
        longest = found.len();
    }
    assert_eq!(longest, records.len());
    for end in 0..400.min(bytes.len()) {
        std::fs::write(&part, &bytes[..end]).unwrap();
        assert!(read(&part).is_ok_and(|read| read.1.is_some()) || read(&part).is_err(), "cut at {end}");
    }
}

#[test]
fn no_spoiled_byte_makes_it_panic_or_lie() {
    let folder = tempfile::tempdir().unwrap();
    let (path, spoiled) = (folder.path().join("day.mcap"), folder.path().join("spoiled.mcap"));
    let show = show(0.3);
    write(&path, &show);
    let (bytes, records) = (std::fs::read(&path).unwrap(), only_records(&show));
    let mut refused = 0;
    for at in 0..bytes.len() {
        let mut copy = bytes.clone();
        copy[at] ^= 0x41;
        std::fs::write(&spoiled, copy).unwrap();
        match read(&spoiled) {
            Err(_) => refused += 1,
            Ok((found, ending)) => {
                refused += usize::from(ending.is_some());
                assert!(found == records[..found.len()], "byte {at}");
                assert!(
                    ending.is_some() || found.len() == records.len(),
                    "byte {at}: what is missing is told"
                );
            }
        }
    }
    assert!(refused > bytes.len() / 4, "{refused} of {} are noticed", bytes.len());
}

const VICTIM: &str = "LIGHTLOOM_TAPE_VICTIM";

/// What the process does that is killed: it records on a clock that is real.
#[test]
fn a_process_that_records_until_it_is_killed() {
    let Ok(path) = std::env::var(VICTIM) else { return };
    let mut writer = Writer::create(Path::new(&path), head(), Limits::default()).unwrap();
    let began = Instant::now();
    for number in 0.. {
        let now = began.elapsed();
        writer.write(now, pose(now, f64::from(number)));
        writer.write(now, frame(number, now));
        // Whole or not at all: the kill may come between any two instructions.
        std::fs::write(format!("{path}.next"), now.as_nanos().to_string()).unwrap();
        std::fs::rename(format!("{path}.next"), format!("{path}.now")).unwrap();
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_kill_loses_at_most_a_second() {
    let folder = tempfile::tempdir().unwrap();
    for (round, wait_ms) in [700_u64, 1500, 2600].into_iter().enumerate() {
        let path = folder.path().join(format!("{round}.mcap"));
        let mut victim = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "a_process_that_records_until_it_is_killed"])
            .env(VICTIM, &path)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(wait_ms));
        victim.kill().unwrap();
        victim.wait().unwrap();
        let last: u128 = std::fs::read_to_string(format!("{}.now", path.display())).unwrap().parse().unwrap();
        let (records, ending) = read(&path).unwrap();
        assert!(ending.is_some(), "it was never completed");
        let last_kept = match records.last() {
            Some(Record::Frame(frame)) => u128::from(frame.now_ns),
            Some(Record::Deed(Deed::Event(event))) => event.received.as_nanos(),
            other => panic!("{other:?} after {wait_ms} ms: {ending:?}"),
        };
        let lost_ms = last.saturating_sub(last_kept) / 1_000_000;
        // A second, and what the writing thread may wait on a busy machine.
        assert!(lost_ms < 1200, "{lost_ms} ms are lost");
    }
}

#[test]
fn a_part_of_a_tape_begins_with_things_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let (path, to) = (folder.path().join("day.mcap"), folder.path().join("part.mcap"));
    let show = show(3.0);
    write(&path, &show);
    assert_eq!(cut(&path, &to, 1.0..2.0).unwrap(), 60);
    let (records, ending) = read(&to).unwrap();
    assert_eq!(ending, None);
    assert!(matches!(
        &records[0],
        Record::Deed(Deed::Event(Event { what: What::Button { is_down: true, .. }, .. }))
    ));
    let frames = records.iter().filter_map(|record| match record {
        Record::Frame(frame) => Some(frame.frame),
        _ => None,
    });
    assert_eq!(frames.collect::<Vec<_>>(), (60..120).collect::<Vec<_>>());
    assert!(matches!(cut(&path, &to, 50.0..60.0), Err(TapeError::NothingThere { .. })));
    assert!(!folder.path().join("part.mcap.part").exists());
}

#[test]
fn what_is_on_it_is_told_and_written_as_tables() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("day.mcap");
    let show = show(2.0);
    write(&path, &show);
    let info = info(&path).unwrap();
    assert_eq!((info.frames, info.events["ball \"two\""], info.events["wand"]), (120, 120, 5));
    assert!((info.length_s - 119.0 / 60.0).abs() < 1e-6 && info.ending == Ending::Whole);
    assert_eq!(info.files["scene.toml"], 9);
    let table = |format| {
        let mut out = Vec::new();
        export(&path, format, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    };
    let csv = table(Format::Csv);
    assert_eq!(csv.lines().count(), 1 + show.len());
    let columns = |line: &str| line.replace("\"ball \"\"two\"\"\"", "ball").split(',').count();
    assert!(csv.lines().all(|line| columns(line) == 13), "{csv}");
    for line in table(Format::Json).lines() {
        serde_json::from_str::<serde_json::Value>(line).unwrap();
    }
}

#[test]
fn long_tapes_go_on_in_parts_and_the_oldest_go() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("day.mcap");
    let limits = Limits { part_bytes: Some(20_000), keep_parts: Some(3) };
    let mut writer = Writer::create(&path, head(), limits).unwrap();
    for (now, record) in show(40.0) {
        writer.write(now, record);
        std::thread::sleep(Duration::from_micros(50));
    }
    writer.finish().unwrap();
    let mut names: Vec<PathBuf> =
        std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    assert_eq!(names.len(), 3, "{names:?}");
    let mut numbers = Vec::new();
    for name in &names {
        let tape = Tape::open(name).unwrap();
        assert_eq!((&tape.head().files, &tape.head().sources), (&head().files, &head().sources));
        numbers.extend(tape.records().map(Result::unwrap).filter_map(|record| match record {
            Record::Frame(frame) => Some(frame.frame),
            _ => None,
        }));
    }
    assert_eq!(numbers.last(), Some(&2399));
    assert!(numbers.windows(2).all(|pair| pair[1] == pair[0] + 1), "nothing is missing between parts");
}

#[test]
fn a_full_disk_is_told_and_holds_up_nothing() {
    if !Path::new("/dev/full").exists() {
        return eprintln!("skipped: this system has no /dev/full");
    }
    let error = Writer::create(Path::new("/dev/full"), head(), Limits::default()).err().unwrap();
    assert!(error.to_string().contains("cannot write the tape /dev/full"), "{error}");
}

#[test]
fn what_is_no_tape_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.mcap");
    let refused = |path: &Path| Tape::open(path).err().unwrap().to_string();
    assert!(refused(Path::new("/no/such/tape")).contains("cannot read the tape"));
    assert!(refused(folder.path()).contains("no regular file"));
    std::fs::write(&path, b"").unwrap();
    assert!(refused(&path).contains("is no tape"), "{}", refused(&path));
    std::fs::write(&path, "[volume]\n").unwrap();
    assert!(refused(&path).contains("is no tape"));
    let mut foreign =
        mcap::Writer::new(std::io::BufWriter::new(std::fs::File::create(&path).unwrap())).unwrap();
    foreign.finish().unwrap();
    drop(foreign);
    assert!(refused(&path).contains("of another program"));
    let options = mcap::WriteOptions::new().profile("lightloom");
    let mut newer = options.create(std::io::BufWriter::new(std::fs::File::create(&path).unwrap())).unwrap();
    let metadata = [("format".to_owned(), "2".to_owned())].into();
    newer.write_metadata(&mcap::records::Metadata { name: "lightloom".to_owned(), metadata }).unwrap();
    newer.finish().unwrap();
    drop(newer);
    assert!(refused(&path).contains("format 2, and this program reads up to 1"));
}

/// A tape of format 1, as it was written when that format was made, and its records as JSON.
#[test]
fn a_tape_of_format_1_still_plays() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let (path, table) = (data.join("format-1.mcap"), data.join("format-1.json"));
    if std::env::var("LIGHTLOOM_WRITE_TAPE").is_ok() {
        write(&path, &show(0.5));
        let mut out = Vec::new();
        export(&path, Format::Json, &mut out).unwrap();
        std::fs::write(&table, out).unwrap();
    }
    let mut out = Vec::new();
    export(&path, Format::Json, &mut out).unwrap();
    // Line by line as values: the order of keys is that of whoever writes them.
    let values = |text: &str| -> Vec<serde_json::Value> {
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    let (found, expected) =
        (values(&String::from_utf8(out).unwrap()), std::fs::read_to_string(&table).unwrap());
    for (line, (found, expected)) in found.iter().zip(values(&expected)).enumerate() {
        assert_eq!(*found, expected, "line {}", line + 1);
    }
    assert_eq!(found.len(), expected.lines().count());
    assert_eq!(Tape::open(&path).unwrap().head(), &head());
}
