//! What becomes of a show whose inputs are killed, garbled, flooded, paused, and brought back, by random schedules.
//!
//! `cargo run --release -p lightloom-tests --example faults -- [SCHEDULES] [SEED]`
//!
//! A real exhibit with three visitors, whose wands come over this host's sockets: DTrack and OSC in datagrams, VRPN over a
//! connection. A schedule is a fault at random for each, then a time of health in which all must be heard again.

mod packets;
mod senders;

use lightloom_tests::processes::{open_files, resident_mib, signal};
use lightloom_tests::program::{late_frames, lightloom, small_display, start};
use lightloom_tests::random::Random;
use lightloom_tests::results::{Program, Results};
use senders::{Fault, KINDS, Sender};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::net::{Ipv4Addr, UdpSocket};
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;
use tape::{Record, Tape};
use world::Deed;

const SCHEDULES: u32 = 100;
const SEED: u64 = 16;
/// A time of health: longer than the longest pause between two attempts to connect to a source, which is 5 s.
const HEALTHY: Duration = Duration::from_millis(6500);
/// How long it may take to end.
const PARTING: Duration = Duration::from_secs(60);
/// How long the tape may take: floods put millions of poses on it.
const REPLAY: Duration = Duration::from_secs(1800);
/// Until the volume is there.
const OPENING: Duration = Duration::from_secs(5);

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let mut number = |otherwise: u64| -> Result<u64, String> {
        arguments
            .next()
            .map_or(Ok(otherwise), |text| text.parse())
            .map_err(|_| "give whole numbers".to_owned())
    };
    let (schedules, seed) = (number(u64::from(SCHEDULES))? as u32, number(SEED)?);
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let ports = KINDS.map(|_| free_port());
    let exhibit = write_exhibit(folder.path(), ports).map_err(|error| error.to_string())?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (tape, log) = (path("day.mcap"), path("log.txt"));
    let arguments = [
        "exhibit", &exhibit, "--output", "none", "--device", "cpu", "--record", &tape, "--log", &log,
        "--json",
    ];
    let running = start(&mut lightloom(&arguments));
    let process = running.process();
    sleep(OPENING);
    let senders: Vec<Sender> =
        KINDS.into_iter().zip(ports).map(|(kind, port)| Sender::start(kind, port)).collect();
    sleep(HEALTHY);
    let before = [resident_mib(process), open_files(process) as f64];
    let tried = torment(&senders, schedules, &mut Random(seed));
    let after = [resident_mib(process), open_files(process) as f64];
    drop(senders);
    signal(process, "INT");
    let limit = running.age() + PARTING;
    let ran = running.finish(limit).succeeded();
    let report: Value =
        serde_json::from_str(&ran.stdout).map_err(|error| format!("{error}: {}", ran.stderr))?;
    let heard = heard(Path::new(&tape), schedules)?;
    let again = start(&mut lightloom(&[
        "exhibit",
        &exhibit,
        "--tape",
        &tape,
        "--output",
        "none",
        "--device",
        "cpu",
        "--stepped",
        "--quiet",
    ]))
    .finish(REPLAY);
    let log = fs::read_to_string(&log).map_err(|error| error.to_string())?;
    write(
        &Found {
            tried,
            heard,
            report,
            before,
            after,
            again: again.code == Some(0) && !again.stderr.contains("is not what it was"),
            log,
        },
        schedules,
    )
}

/// What there is to say of a show.
struct Found {
    /// How often each source met each fault.
    tried: [[u32; Fault::ALL.len()]; KINDS.len()],
    heard: Heard,
    report: Value,
    /// MiB in memory, and open files.
    before: [f64; 2],
    after: [f64; 2],
    /// Whether the tape shows the same frames again.
    again: bool,
    log: String,
}

/// The schedules, one after the other.
fn torment(
    senders: &[Sender],
    schedules: u32,
    random: &mut Random,
) -> [[u32; Fault::ALL.len()]; KINDS.len()] {
    let mut tried = [[0; Fault::ALL.len()]; KINDS.len()];
    for schedule in 0..schedules {
        for (sender, tried) in senders.iter().zip(&mut tried) {
            let at = random.below(Fault::ALL.len() as u64) as usize;
            tried[at] += 1;
            sender.suffer(Fault::ALL[at]);
        }
        sleep(Duration::from_millis(200 + random.below(1800)));
        senders.iter().for_each(|sender| sender.recover(schedule));
        sleep(HEALTHY);
    }
    tried
}

/// What a tape says that was heard.
#[derive(Default)]
struct Heard {
    /// The schedules after which each source was heard again.
    again: [BTreeSet<u32>; KINDS.len()],
    frames: u32,
    /// Frames whose number does not follow.
    gaps: u32,
    poses: u64,
}

fn heard(path: &Path, schedules: u32) -> Result<Heard, String> {
    let tape = Tape::open(path).map_err(|error| error.to_string())?;
    let mut heard = Heard::default();
    let mut next = None;
    for record in tape.records() {
        match record.map_err(|error| error.to_string())? {
            Record::Frame(frame) => {
                heard.gaps += u32::from(next.is_some_and(|next| next != frame.frame));
                next = Some(frame.frame + 1);
                heard.frames += 1;
            }
            Record::Deed(Deed::Event(event)) => {
                let inputs::What::Pose { pose: Some(pose), .. } = event.what else { continue };
                heard.poses += 1;
                let source = usize::from(event.source.0);
                // A garbled pose may be anywhere.
                let schedule = packets::schedule_at(pose.position_m().x).filter(|&found| found < schedules);
                if let (Some(schedule), Some(again)) = (schedule, heard.again.get_mut(source)) {
                    again.insert(schedule);
                }
            }
            _ => {}
        }
    }
    Ok(heard)
}

fn write(found: &Found, schedules: u32) -> Result<(), String> {
    let Found { tried, heard, report, before, after, again, log } = found;
    let mut results = Results::new(Program::Study("faults"), "faults", "schedules");
    let beat = &report["beat"];
    results.line(format!("{schedules} random schedules in one show of {:.0} s, three sources each time; between them {:.1} s of health. Four projectors of 96 × 72, no output, on tape.\n", report["seconds"].as_f64().unwrap_or(f64::NAN), HEALTHY.as_secs_f64()));
    results.line(format!("| source | {} | heard again after |", Fault::ALL.map(Fault::name).join(" | ")));
    results.line(format!("| --- |{} ---: |", " ---: |".repeat(Fault::ALL.len())));
    for ((kind, tried), again) in KINDS.iter().zip(tried).zip(&heard.again) {
        let counts: Vec<String> = tried.iter().map(u32::to_string).collect();
        results.line(format!(
            "| {} | {} | {} of {schedules} |",
            kind.name(),
            counts.join(" | "),
            again.len()
        ));
    }
    results.line("\n| | |\n| --- | --- |");
    let late = late_frames(beat);
    let times = |key: &str| {
        let [p50, p99, max] = ["p50", "p99", "max"].map(|name| beat[key][name].as_f64().unwrap_or(f64::NAN));
        format!("{p50:.1} / {p99:.1} / {max:.1}")
    };
    let laws = log.lines().filter(|line| line.contains("against its laws")).count();
    let lines = |word: &str| log.lines().filter(|line| line.contains(word)).count();
    for (name, value) in [
        (
            "frames made, shown, shown late by a back-end",
            format!("{}, {}, {late}", heard.frames, beat["frames"]),
        ),
        ("frames whose number does not follow", heard.gaps.to_string()),
        ("from frame to frame, ms: median, 99 %, largest", times("interval_ms")),
        ("from input to shown, ms", times("input_to_shown_ms")),
        ("poses that reached the world", heard.poses.to_string()),
        (
            "sentences in the log, of which name a source that is lost",
            format!("{}, {}", log.lines().count(), lines("lost")),
        ),
        ("times that the world was against its laws", laws.to_string()),
        ("the tape shows the same frames again", again.to_string()),
        ("memory of the process, MiB, before and after", format!("{:.1}, {:.1}", before[0], after[0])),
        ("open files", format!("{}, {}", before[1], after[1])),
    ] {
        results.line(format!("| {name} | {value} |"));
    }
    results.finish()?;
    let is_whole = heard.again.iter().all(|again| again.len() == schedules as usize);
    match is_whole && *again && laws == 0 && heard.gaps == 0 {
        true => Ok(()),
        false => Err("something was lost: see the table".to_owned()),
    }
}

/// A port of this host that nothing listens at.
fn free_port() -> u16 {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("this host has ports");
    socket.local_addr().expect("a bound socket has an address").port()
}

fn write_exhibit(folder: &Path, ports: [u16; KINDS.len()]) -> std::io::Result<String> {
    small_display(folder);
    let inputs: Vec<String> = KINDS.iter().zip(ports).map(|(kind, port)| kind.entry(port)).collect();
    fs::write(folder.join("wands.toml"), inputs.concat())?;
    let tools = ["clip-plane", "probe", "pointer"].iter().zip(KINDS).zip(["Ada", "Ben", "Cem"]);
    let tools: Vec<String> = tools
        .map(|((tool, kind), visitor)| {
            format!(
                "[[visitor]]\nname = '{visitor}'\n[[tool]]\nname = 'tool of {visitor}'\nvisitor = '{visitor}'\n\
                 input = '{}'\nkinds = ['{tool}']\nbuttons = {{ 0 = 'grab' }}\n",
                kind.name()
            )
        })
        .collect();
    let path = folder.join("exhibit.toml");
    let text = format!(
        "title = 'Tormented'\ndisplay = 'small4.toml'\ninputs = 'wands.toml'\nquality = 'draft'\n\
         [[item]]\ntitle = 'Shells'\nscene = 'procedural:shells@64'\n{}",
        tools.concat()
    );
    fs::write(&path, text)?;
    Ok(path.to_string_lossy().into_owned())
}
