//! Commands that need no back-end, started as a job that has some.

use lightloom_tests::program::{cluster, run, small_display};
use std::fs;
use std::time::{Duration, Instant};

/// The launcher takes a second or two for itself.
const A_MOMENT: Duration = Duration::from_secs(30);

#[test]
fn commands_that_draw_nothing_let_their_back_ends_go() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (store, exported, out) = (path("a.lloom"), path("a.nrrd"), path("out"));
    let import = ["import", "procedural:shells@16", "-o", &store];
    let accuracy = ["accuracy", "procedural:shells@16", "-o", &out, "--device", "cpu", "--stride", "40"];
    let display = small_display(folder.path());
    let quick = ["--repetitions", "1", "--projectors", "1", "--display", &display];
    let commands: [(&[&str], &str); 7] = [
        (&import, "16 × 16 × 16 voxels"),
        (&["info", &store], "made from"),
        (&["verify", &store], "whole: "),
        (&["export", &store, &exported], "a.nrrd"),
        (&["displays"], "holo72"),
        (&["--version"], "lightloom "),
        (&[&accuracy[..], &quick].concat(), "accuracy.html"),
    ];
    for (arguments, word) in commands {
        let since = Instant::now();
        let Some(mut command) = cluster(arguments, 2) else { return };
        let ran = run(&mut command).succeeded();
        assert!(ran.stdout.contains(word), "{arguments:?}: {ran:?}");
        assert!(since.elapsed() < A_MOMENT, "{arguments:?}: {:?}", since.elapsed());
    }
    assert!(fs::metadata(&exported).unwrap().len() > 16 * 16 * 16);
    let Some(mut command) = cluster(&["info", &path("nowhere.lloom")], 2) else { return };
    run(&mut command).refused(&["nowhere.lloom"]);
}
