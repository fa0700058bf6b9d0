//! A renderer that ends or hangs under a launcher comes back while the show goes on.

use lightloom_tests::comeback::{BACKENDS, Show};
use lightloom_tests::processes::{children, is_there, signal};
use lightloom_tests::program::{LIMIT, cluster, run, scene_of_skins, small_display};
use serde_json::Value;
use std::fs;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A machine that does other things as well takes a few times as long as it should.
const BACK_WITHIN: Duration = Duration::from_secs(8);

/// All that a launcher started, from the ranks down.
fn descendants(launcher: u32) -> Vec<u32> {
    let ranks = children(launcher);
    ranks.iter().copied().chain(ranks.iter().flat_map(|&rank| children(rank))).collect()
}

#[track_caller]
fn are_gone(processes: &[u32]) {
    let since = Instant::now();
    while let Some(left) = processes.iter().find(|&&process| is_there(process)) {
        assert!(since.elapsed() < Duration::from_secs(5), "process {left} is still there");
        sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_killed_and_a_stopped_renderer_come_back_to_the_complete_picture() {
    let Some(show) = Show::begin(25) else { return };
    let before = descendants(show.launcher());
    let mut newest = 0;
    for (backend, name) in [(1_usize, "KILL"), (2, "STOP")] {
        let kept = show.renderers();
        assert_eq!(kept.len(), BACKENDS as usize, "{kept:?}");
        let comeback = show.end(kept[backend], name, newest).expect("it comes back");
        assert!(comeback.right < BACK_WITHIN, "{name}: {comeback:?}");
        newest = show.newest(newest).unwrap();
        // The others have been there all the time; one may be late for a frame.
        let is_right = |other: u32| (newest - 5..newest).any(|frame| show.is_right(frame, other));
        assert!((0..BACKENDS).filter(|&other| other != backend as u32).all(is_right), "{name}");
        let now = show.renderers();
        assert!((0..now.len()).all(|one| (now[one].process == kept[one].process) == (one != backend)));
    }
    let processes = [before, descendants(show.launcher())].concat();
    let ran = show.finish(LIMIT).succeeded();
    are_gone(&processes);
    for part in ["is lost, and is started again", "signal 9 (SIGKILL)", "gave no sign of life", "shows again"]
    {
        assert!(ran.stderr.contains(part), "no `{part}` in {}", ran.stderr);
    }
    let report: Value = serde_json::from_str(&ran.stdout).expect("the report is JSON");
    assert_eq!(report["end"], "planned");
    let lost: Vec<u64> =
        (0..4).map(|one| report["beat"]["backends"][one]["lost"].as_u64().unwrap()).collect();
    assert_eq!(lost, [0, 1, 1, 0], "{report}");
    assert!(report["beat"]["backends"][2]["away_ms"]["max"].as_f64().unwrap() > 0.0, "{report}");
}

/// A show that ends while a back-end is away ends as any other.
#[test]
fn a_show_ends_well_while_a_renderer_is_away() {
    let Some(show) = Show::begin(12) else { return };
    let processes = descendants(show.launcher());
    let ends_at = Duration::from_secs(12);
    sleep((ends_at.saturating_sub(show.age())).saturating_sub(Duration::from_secs(1)));
    assert!(signal(show.renderers()[3].process, "STOP"));
    show.finish(LIMIT).succeeded();
    are_gone(&processes);
}

#[test]
fn a_launcher_that_is_asked_to_end_takes_renderers_along_also_stopped_ones() {
    let Some(show) = Show::begin(60) else { return };
    assert!(signal(show.renderers()[0].process, "STOP"));
    let processes = descendants(show.launcher());
    assert!(signal(show.launcher(), "TERM"));
    let limit = show.age() + Duration::from_secs(15);
    let ran = show.finish(limit);
    assert_ne!(ran.code, Some(0));
    assert!(!ran.stderr.contains("is lost"), "{ran:?}");
    are_gone(&processes);
}

/// The keeper is the rank: without it there is no job.
#[test]
fn a_keeper_that_dies_ends_the_show_with_a_sentence() {
    let Some(show) = Show::begin(60) else { return };
    let processes = descendants(show.launcher());
    let victim = show.renderers()[1];
    assert!(signal(victim.keeper, "KILL"));
    let limit = show.age() + Duration::from_secs(15);
    let ran = show.finish(limit);
    assert!(ran.code.is_some_and(|code| code != 0), "{ran:?}");
    let sentence = format!("process {} on host", victim.keeper);
    let named = ran.stderr.lines().find(|line| line.starts_with("lightloom: ") && line.contains(&sentence));
    assert!(named.is_some_and(|line| line.contains("back-end 1 ")), "{ran:?}");
    are_gone(&processes);
}

/// What is wrong with the first frame is no reason to try again.
#[test]
fn a_show_that_cannot_begin_says_why_and_ends() {
    let folder = tempfile::tempdir().unwrap();
    let (display, scene) = (small_display(folder.path()), folder.path().join("bent.toml"));
    // Row planes know straight rays only.
    fs::write(&scene, scene_of_skins("procedural:shells@32", "refraction = [[0.0, 1.0], [1.0, 1.4]]\n"))
        .unwrap();
    let wanted = ["drive", &scene.to_string_lossy(), "--display", &display, "--output", "none"];
    let Some(mut command) = cluster(&[&wanted[..], &["--device", "cpu", "--caster", "planes"]].concat(), 2)
    else {
        return;
    };
    let ran = run(&mut command);
    assert!(ran.code.is_some_and(|code| code != 0), "{ran:?}");
    let is_reason = |line: &&str| line.starts_with("lightloom: back-end ") && line.contains("light is bent");
    assert_eq!(ran.stderr.lines().filter(is_reason).count(), 1, "{ran:?}");
    assert!(!ran.stderr.contains("is lost"), "{ran:?}");
}
