//! Careless use: what a person or a script may ask for without thinking.

use lightloom_tests::program::{files, lightloom, run, scene_of_skins, small_display, test_data};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output, Stdio};

struct Bench {
    folder: tempfile::TempDir,
    display: String,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let display = small_display(folder.path());
        Self { folder, display }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_string_lossy().into_owned()
    }

    /// The arguments of a small run on the CPU.
    fn simulate<'a>(&'a self, scene: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
        let fixed = ["simulate", scene, "--display", &self.display, "--device", "cpu", "--out", out];
        [&fixed[..], more].concat()
    }

    /// A store of 5 × 6 × 4 voxels.
    fn store(&self, name: &str) -> String {
        let (made, store) = (self.path("made.lloom"), self.path(name));
        run(&mut lightloom(&["import", &test_data("short.nrrd"), "-o", &made, "--quiet"])).succeeded();
        fs::rename(made, &store).unwrap();
        store
    }
}

fn with_stdout(arguments: &[&str], stdout: Stdio) -> Output {
    let mut command: Command = lightloom(arguments);
    command
        .stdin(Stdio::null())
        .stdout(stdout)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
        .wait_with_output()
        .unwrap()
}

#[test]
fn what_cannot_be_printed_is_an_error_unless_nobody_reads_it() {
    let bench = Bench::new();
    let (store, out, exported) = (bench.store("a.lloom"), bench.path("out"), bench.path("a.nrrd"));
    let (copy, input) = (bench.path("b.lloom"), test_data("short.nrrd"));
    let commands: [&[&str]; 8] = [
        &["--help"],
        &["--version"],
        &["displays"],
        &["info", &store, "--json"],
        &["verify", &store],
        &["import", &input, "-o", &copy],
        &["export", &store, &exported],
        &bench.simulate("procedural:shells@16", &out, &["--json"]),
    ];
    for arguments in commands {
        let full = with_stdout(arguments, File::create("/dev/full").unwrap().into());
        let said = String::from_utf8_lossy(&full.stderr).into_owned();
        assert_eq!(full.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.starts_with("lightloom: cannot write to standard output: "), "{arguments:?}: {said}");
    }
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let closed = with_stdout(&["info", &store], writer.into());
    assert_eq!((closed.status.code(), closed.stderr.len()), (Some(0), 0));
}

#[test]
fn who_gives_no_arguments_gets_the_help() {
    let ran = run(&mut lightloom::<&str>(&[]));
    assert_eq!((ran.code, ran.stdout.as_str()), (Some(2), ""));
    assert!(ran.stderr.starts_with("Volume rendering") && ran.stderr.contains("simulate"), "{}", ran.stderr);
}

#[test]
fn back_ends_beyond_the_projectors_are_not_even_started() {
    let bench = Bench::new();
    let out = bench.path("out");
    for backends in ["5", "20000", "100000000"] {
        let arguments = bench.simulate("procedural:shells@16", &out, &["--backends", backends]);
        run(&mut lightloom(&arguments)).refused(&[backends, "4 projectors"]);
    }
}

#[test]
fn numbers_beyond_the_renderer_are_told_with_file_and_line() {
    let bench = Bench::new();
    let (scene, out) = (bench.path("scene.toml"), bench.path("out"));
    for (more, place) in [
        ("[light]\nambient = 1e30\n", "`light.ambient`"),
        ("[quality]\nlod_scale = 1e7\n", "`quality.lod_scale`"),
        ("[placement]\nscale = 1\ncentre_m = [0, 0, 0, nan]\n", "`placement.centre_m`"),
    ] {
        fs::write(&scene, scene_of_skins("procedural:shells@16", more)).unwrap();
        run(&mut lightloom(&bench.simulate(&scene, &out, &[]))).refused(&[&scene, "line ", place]);
    }
    assert!(!Path::new(&out).exists());
}

#[test]
fn a_scene_s_source_that_is_no_store_is_told_with_file_and_line() {
    let bench = Bench::new();
    let (scene, out) = (bench.path("scene.toml"), bench.path("out"));
    fs::write(bench.path("text.lloom"), "no store").unwrap();
    for source in ["nowhere.lloom", "text.lloom", ""] {
        fs::write(&scene, format!("[volume]\n\nsource = '{source}'\n")).unwrap();
        let place = format!("{scene}, line 3: `volume.source`: ");
        run(&mut lightloom(&bench.simulate(&scene, &out, &[]))).refused(&[&place, source]);
    }
}

#[test]
fn a_store_of_any_name_can_be_shown() {
    let bench = Bench::new();
    let (store, out) = (bench.store("head"), bench.path("out"));
    run(&mut lightloom(&bench.simulate(&store, &out, &[]))).succeeded();
    assert!(files(Path::new(&out)).contains_key("frame-0000/projector-00.png"));
}

#[test]
fn a_shorter_run_into_the_same_folder_stands_alone() {
    let bench = Bench::new();
    let (scene, out) = (bench.path("scene.toml"), bench.path("out"));
    fs::write(&scene, scene_of_skins("procedural:shells@16", "[frames]\ncount = 3\n")).unwrap();
    let longer = bench.simulate(&scene, &out, &["--exr", "--eye", "0,0,1.2", "--debug-view", "lod"]);
    run(&mut lightloom(&longer)).succeeded();
    fs::write(Path::new(&out).join("frame-0001/notes.txt"), "mine").unwrap();
    run(&mut lightloom(&bench.simulate("procedural:shells@16", &out, &[]))).succeeded();
    let pictures = (0..4).map(|p| format!("frame-0000/projector-{p:02}.png"));
    let others =
        ["contact-sheet.png", "frame-0001/notes.txt", "report.html", "report.json"].map(str::to_owned);
    let mut expected: Vec<String> = pictures.chain(others).collect();
    expected.sort();
    assert_eq!(files(Path::new(&out)).into_keys().collect::<Vec<_>>(), expected);
}

#[test]
fn endless_inputs_are_refused_at_once() {
    let bench = Bench::new();
    let (zero, out) = (bench.path("zero.toml"), bench.path("out"));
    std::os::unix::fs::symlink("/dev/zero", &zero).unwrap();
    run(&mut lightloom(&bench.simulate(&zero, &out, &[]))).refused(&[&zero, "no regular file"]);
    let display = ["simulate", "procedural:shells@16", "--display", &zero, "--out", &out];
    run(&mut lightloom(&display)).refused(&[&zero, "no regular file"]);
    run(&mut lightloom(&["replay", &zero])).refused(&[&zero, "a pipe or a device"]);
    let long = bench.path("long.trace");
    fs::write(&long, vec![b'x'; 64 << 20]).unwrap();
    run(&mut lightloom(&["replay", &long])).refused(&[&long, "too long for a trace"]);
}

#[test]
fn a_trace_counts_once() {
    let bench = Bench::new();
    let (out, traces) = (bench.path("out"), bench.path("traces"));
    let live = bench.simulate("procedural:shells@16", &out, &["--live", "--trace", &traces]);
    run(&mut lightloom(&live)).succeeded();
    let trace = format!("{traces}/backend-0.trace");
    let linked = bench.path("linked.trace");
    fs::hard_link(&trace, &linked).unwrap();
    for again in [format!("{traces}/../traces/backend-0.trace"), linked] {
        run(&mut lightloom(&["replay", &trace, &again])).refused(&[&again, "given twice"]);
    }
}

#[test]
fn no_scene_commands_the_terminal() {
    let bench = Bench::new();
    let (scene, out) = (bench.path("title.toml"), bench.path("out"));
    fs::write(&scene, "[volume]\nsource = \"\\u001b]0;title\\u0007.lloom\"\n").unwrap();
    let ran = run(&mut lightloom(&bench.simulate(&scene, &out, &[])));
    ran.refused(&[&scene, "line 2", "title"]);
    assert!(!ran.stderr.contains(['\u{1b}', '\u{7}']), "{ran:?}");
}

#[test]
fn a_name_that_nobody_reads_is_cut_off() {
    let bench = Bench::new();
    let (scene, out) = (bench.path("long.toml"), bench.path("out"));
    fs::write(&scene, format!("[volume]\nsource = \"{}.lloom\"\n", "x".repeat(200_000))).unwrap();
    let ran = run(&mut lightloom(&bench.simulate(&scene, &out, &[])));
    ran.refused(&[&scene, "line 2", "xxx…"]);
    assert!(ran.stderr.len() < 2000, "{}", ran.stderr.len());
}
