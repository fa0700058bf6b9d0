//! A back-end process that dies ends the run with a sentence that names it, within seconds.

use lightloom_tests::machine;
use lightloom_tests::processes::{children, command_line, is_there, ticks};
use lightloom_tests::program::{cluster, files, run, start};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// From a death to the end of all that was started.
const OVER_WITHIN: Duration = Duration::from_secs(10);

/// Opening the volume and starting to draw takes no longer.
const DRAWING_WITHIN: Duration = Duration::from_secs(60);

const BACKENDS: u32 = 3;

/// The back-ends of this job: by the launcher that started them.
fn backends_of(launcher: u32) -> Vec<u32> {
    let mut backends = children(launcher);
    backends.retain(|&process| command_line(process).contains("lightloom-backend"));
    backends
}

/// Waits until every back-end has worked for a while.
fn await_drawing(launcher: u32) -> Vec<u32> {
    const TICKS_OF_WORK: u64 = 150;
    let since = Instant::now();
    loop {
        let backends = backends_of(launcher);
        if backends.len() == BACKENDS as usize && backends.iter().all(|b| ticks(*b) > TICKS_OF_WORK) {
            return backends;
        }
        assert!(since.elapsed() < DRAWING_WITHIN, "the back-ends {backends:?} do not draw");
        sleep(Duration::from_millis(50));
    }
}

#[test]
fn a_back_end_killed_while_it_draws() {
    machine::alone();
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out_text = out.to_string_lossy().into_owned();
    let arguments =
        ["simulate", "procedural:shells", "--display", "holo72", "--device", "cpu", "--out", &out_text];
    let Some(mut command) = cluster(&arguments, BACKENDS) else { return };
    let job = start(&mut command);
    let backends = await_drawing(job.process());
    let victim = backends[1];
    let killed = Command::new("kill").args(["-9", &victim.to_string()]).status().unwrap();
    assert!(killed.success());
    let died_at = job.age();

    let ran = job.finish(died_at + OVER_WITHIN);
    assert!(ran.code.is_some_and(|code| code != 0), "{ran:?}");
    // Three back-ends are not as many as the display file wires, which is worth a warning of its own.
    let is_end = |line: &&str| line.starts_with("lightloom: ") && !line.starts_with("lightloom: warning: ");
    let sentences: Vec<_> = ran.stderr.lines().filter(is_end).collect();
    assert_eq!(sentences.len(), 1, "{ran:?}");
    for part in ["back-end ", &format!("process {victim} on host"), "ended while drawing frame 0"] {
        assert!(sentences[0].contains(part), "no `{part}` in: {}", sentences[0]);
    }
    let since = Instant::now();
    while backends.iter().any(|backend| is_there(*backend)) {
        assert!(since.elapsed() < Duration::from_secs(2), "a back-end is still there");
        sleep(Duration::from_millis(20));
    }
    left_no_half_file(&out);
}

fn left_no_half_file(out: &std::path::Path) {
    for (name, bytes) in files(out) {
        assert!(!name.contains("report") && !name.contains("contact-sheet"), "{name} is there");
        // A PNG ends with the chunk IEND; a part under the name of a working file is no picture.
        if name.ends_with(".png") {
            assert!(bytes.len() > 12 && bytes[bytes.len() - 8..].starts_with(b"IEND"), "{name} is cut short");
        }
    }
}

#[test]
fn a_run_that_loses_nobody() {
    machine::alone();
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").to_string_lossy().into_owned();
    let display = lightloom_tests::program::small_display(folder.path());
    let arguments = [
        "simulate",
        "procedural:shells@32",
        "--display",
        &display,
        "--device",
        "cpu",
        "--out",
        &out,
        "--quiet",
    ];
    let Some(mut command) = cluster(&arguments, 2) else { return };
    run(&mut command).succeeded();
}
