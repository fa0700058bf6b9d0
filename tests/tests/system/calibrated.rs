//! A calibrated display: `simulate --calibrated` writes what `drive` shows, whoever draws it.

use lightloom_tests::calibrated;
use lightloom_tests::program::{
    LIMIT, Pictures, assert_same, cluster, lightloom, pictures, run, small_display, start,
};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SCENE: &str = "procedural:shells@64";

/// What `simulate --calibrated` writes for a display, and the pictures beside it under the same names.
fn simulated(folder: &TempDir, display: &str, device: &[&str]) -> [Pictures; 2] {
    let out = folder.path().join("out").to_string_lossy().into_owned();
    let fixed = ["simulate", SCENE, "--display", display, "--out", &out, "--quiet", "--calibrated"];
    run(&mut lightloom(&[&fixed[..], device].concat())).succeeded();
    let all = pictures(&Path::new(&out).join("frame-0000"));
    ["calibrated", "projector"].map(|kind| {
        let of_kind = |(name, bytes): (&String, &Vec<u8>)| {
            Some((name.strip_prefix(kind).map(|rest| format!("projector{rest}"))?, bytes.clone()))
        };
        all.iter().filter_map(of_kind).collect()
    })
}

/// The arguments of a show of one whole frame that is dumped.
fn shown<'a>(display: &'a str, dump: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let fixed =
        ["drive", SCENE, "--display", display, "--output", "none", "--stepped", "--quiet", "--frames", "1"];
    [&fixed[..], &["--reconstruct", "off", "--dump", dump], more].concat()
}

fn dumped(dump: &str) -> Pictures {
    pictures(&Path::new(dump).join("frame-000000"))
}

#[test]
fn what_is_simulated_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let display = calibrated::write(folder.path(), [96, 72]);
    let device = ["--device", "cpu"];
    let [codes, plain] = simulated(&folder, &display, &device);
    assert_eq!((codes.len(), plain.len()), (4, 4));
    for (name, bytes) in &codes {
        let is_plain = name == "projector-03.png";
        assert_eq!(*bytes == plain[name], is_plain, "{name}: the last projector alone has no finish");
    }
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    for (dump, backends) in [("one", "1"), ("two", "2")] {
        let dump = path(dump);
        let more = [&device[..], &["--backends", backends]].concat();
        run(&mut lightloom(&shown(&display, &dump, &more))).succeeded();
        assert_same("shown", &codes, &dumped(&dump));
    }
    let dump = path("ranks");
    if let Some(mut command) = cluster(&shown(&display, &dump, &device), 2) {
        start(&mut command).finish(LIMIT).succeeded();
        assert_same("shown by processes, to which the maps were sent", &codes, &dumped(&dump));
    }
}

#[test]
fn a_display_without_a_finish_is_shown_as_it_was_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let [codes, plain] = simulated(&folder, &small_display(folder.path()), &["--device", "cpu"]);
    assert_same("codes", &plain, &codes);
}

#[test]
fn a_map_that_is_missing_is_told_before_anything_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let display = calibrated::write(folder.path(), [96, 72]);
    fs::remove_file(folder.path().join("mirrored.mesh")).unwrap();
    let out = folder.path().join("out").to_string_lossy().into_owned();
    let arguments = ["simulate", SCENE, "--display", &display, "--out", &out];
    run(&mut lightloom(&arguments)).refused(&["`mesh` names", "mirrored.mesh, which cannot be read ("]);
    assert!(!Path::new(&out).exists());
}
