//! Volumes, stores and exports that go wrong: each ends in a sentence or a warning, at once, and leaves nothing behind.

use lightloom_tests::machine;
use lightloom_tests::program::{Ran, files, lightloom, run, start, test_data};
use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// What waits for a pipe waits for ever; a refusal takes a moment.
const A_MOMENT: Duration = Duration::from_secs(10);
/// After a signal, an export takes what it wrote away.
const STOPS_WITHIN: Duration = Duration::from_secs(20);

struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn path(&self, name: &str) -> String {
        self.at(name).to_string_lossy().into_owned()
    }

    fn import(&self, input: &str, more: &[&str]) -> Ran {
        run(&mut lightloom(&[&["import", input, "-o", &self.path("out.lloom")], more].concat()))
    }

    /// `import` succeeds, and warns in a line with all of these parts.
    #[track_caller]
    fn import_warns(&self, input: &str, more: &[&str], parts: &[&str]) {
        let ran = self.import(input, more).succeeded();
        let warnings: Vec<_> = ran.stderr.lines().filter(|line| line.contains("WARN")).collect();
        let is_told = |line: &&&str| parts.iter().all(|part| line.contains(part));
        assert_eq!(warnings.iter().filter(is_told).count(), 1, "{ran:?}");
    }
}

fn mkfifo(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[test]
fn no_command_waits_for_a_pipe() {
    let bench = Bench::new();
    let (nifti, store) = (bench.path("a.nii"), bench.path("a.lloom"));
    mkfifo(Path::new(&nifti));
    mkfifo(Path::new(&store));
    let refused = |arguments: &[&str], path: &str| {
        start(&mut lightloom(arguments)).finish(A_MOMENT).refused(&[path, "pipe"]);
    };
    refused(&["import", &nifti, "-o", &bench.path("b.lloom")], &nifti);
    for command in ["info", "verify"] {
        refused(&[command, &store], &store);
    }
    refused(&["export", &store, &bench.path("b.nrrd")], &store);
    let toml = bench.path("a.toml");
    mkfifo(Path::new(&toml));
    let not_read = |arguments: &[&str]| {
        start(&mut lightloom(arguments)).finish(A_MOMENT).refused(&[&toml, "no regular file"]);
    };
    not_read(&["simulate", &toml, "--out", &bench.path("out")]);
    not_read(&["simulate", "procedural:shells@16", "--display", &toml, "--out", &bench.path("out")]);
    let tape = [
        "simulate",
        "procedural:shells@16",
        "--display",
        "desk8",
        "--out",
        &bench.path("out"),
        "--tape",
        &store,
    ];
    for command in [&["tape", "info", &store][..], &tape] {
        start(&mut lightloom(command)).finish(A_MOMENT).refused(&[&store, "no regular file"]);
    }
    assert_eq!(files_but_pipes(&bench), 0);
}

fn files_but_pipes(bench: &Bench) -> usize {
    fs::read_dir(bench.folder.path())
        .unwrap()
        .filter(|entry| entry.as_ref().unwrap().path().is_file())
        .count()
}

/// The decoder's own panic, which is caught, must not be printed either.
#[test]
fn a_jpeg_of_another_size_is_one_sentence() {
    let bench = Bench::new();
    let mut bytes = fs::read(test_data("dicom/jpeg_baseline.dcm")).unwrap();
    let rows = b"\x28\0\x10\0US\x02\0";
    let at = bytes.windows(rows.len()).position(|part| part == rows).unwrap() + rows.len();
    bytes[at] -= 1;
    fs::write(bench.at("small.dcm"), bytes).unwrap();
    bench.import(&bench.path("small.dcm"), &[]).refused(&["small.dcm", "holds a JPEG of 5 × 6 pixels"]);
}

#[test]
fn numbers_of_a_palette_are_told_of() {
    let bench = Bench::new();
    bench.import_warns(&test_data("tiff/palette.tif"), &[], &["colours of a palette"]);
    // A picture of numbers that says it has a palette.
    let bytes = fs::read(test_data("dicom/padded.dcm")).unwrap();
    let grey = b"MONOCHROME2 ";
    let at = bytes.windows(grey.len()).position(|part| part == grey).unwrap();
    let palette =
        [&bytes[..at - 2], &14u16.to_le_bytes(), b"PALETTE COLOR ", &bytes[at + grey.len()..]].concat();
    fs::write(bench.at("palette.dcm"), palette).unwrap();
    bench.import_warns(&bench.path("palette.dcm"), &[], &["palette.dcm", "colours of a palette"]);
}

#[test]
fn gaps_between_the_names_of_slices_are_told_of() {
    let bench = Bench::new();
    let slices = |name: &str, numbers: &[&str]| {
        fs::create_dir(bench.at(name)).unwrap();
        for number in numbers {
            fs::copy(test_data("tiff/slices/z1.tif"), bench.at(name).join(format!("{number}.tif"))).unwrap();
        }
        bench.path(name)
    };
    let missing = slices("missing", &["s001", "s002", "s003", "s005"]);
    bench.import_warns(&missing, &["--spacing-mm", "1,1,1"], &["s003", "s005", "may be missing"]);
    let two = slices("two", &["s0", "s1", "t0", "t1"]);
    bench.import_warns(&two, &["--spacing-mm", "1,1,1"], &["s1", "t0", "another stack"]);
    let whole = slices("whole", &["s8", "s9", "s10"]);
    assert_eq!(bench.import(&whole, &["--spacing-mm", "1,1,1"]).succeeded().stderr, "");
}

#[test]
fn units_and_scalings_that_make_no_sense_are_told_of_once() {
    let bench = Bench::new();
    bench.import_warns(&test_data("zarr/type_u2.zarr"), &[], &["type_u2.zarr", "millimetres are assumed"]);
    let quiet = bench.import(&test_data("zarr/type_u2.zarr"), &["--spacing-mm", "1,1,1"]).succeeded();
    assert_eq!(quiet.stderr, "");
    // One that nobody knows, on each of three axes.
    let zarr = bench.at("furlongs.zarr");
    fs::create_dir(&zarr).unwrap();
    let known = PathBuf::from(test_data("zarr/xyz_05.zarr"));
    symlink(known.join("0"), zarr.join("0")).unwrap();
    let described = fs::read_to_string(known.join("zarr.json")).unwrap();
    assert_eq!(described.matches("millimeter").count(), 3);
    fs::write(zarr.join("zarr.json"), described.replace("millimeter", "furlong")).unwrap();
    let zarr = zarr.to_string_lossy();
    bench.import_warns(&zarr, &[], &["furlongs.zarr", "millimetres are assumed"]);
    let bytes = fs::read(test_data("ushort.nii")).unwrap();
    let nifti = |numbers: &[(usize, f32)], form: &[(usize, i16)]| {
        let mut changed = bytes.clone();
        numbers.iter().for_each(|&(at, number)| changed[at..at + 4].copy_from_slice(&number.to_le_bytes()));
        form.iter().for_each(|&(at, code)| changed[at..at + 2].copy_from_slice(&code.to_le_bytes()));
        fs::write(bench.at("a.nii"), changed).unwrap();
        bench.path("a.nii")
    };
    bench.import_warns(&nifti(&[(112, f32::INFINITY)], &[]), &[], &["a.nii", "scaling"]);
    bench.import_warns(&nifti(&[(112, 2.0), (116, f32::NAN)], &[]), &[], &["a.nii", "scaling"]);
    let turned = [(256, 0.9), (260, 0.9), (264, 0.0)];
    bench.import_warns(&nifti(&turned, &[(252, 1), (254, 0)]), &[], &["a.nii", "longer than 1"]);
    // What nibabel writes for no scaling.
    assert_eq!(bench.import(&nifti(&[(112, f32::NAN), (116, f32::NAN)], &[]), &[]).succeeded().stderr, "");
}

#[test]
fn stores_are_named_as_stores_and_links_stay_links() {
    let bench = Bench::new();
    let input = test_data("short.nrrd");
    for name in ["head", "head.nrrd", "head.lloom.bak"] {
        run(&mut lightloom(&["import", &input, "-o", &bench.path(name)])).refused(&[name, ".lloom"]);
    }
    assert!(files(bench.folder.path()).is_empty());
    symlink("other.lloom", bench.at("out.lloom")).unwrap();
    bench.import(&input, &[]).succeeded();
    assert!(bench.at("out.lloom").symlink_metadata().unwrap().is_symlink());
    run(&mut lightloom(&["verify", &bench.path("other.lloom")])).succeeded();
}

#[test]
fn names_need_not_be_text() {
    let bench = Bench::new();
    let name = |bytes: &[u8]| bench.folder.path().join(OsStr::from_bytes(bytes));
    fs::copy(test_data("short.nrrd"), name(b"\xff.nrrd")).unwrap();
    let mut command = lightloom(&["import"]);
    run(command.arg(name(b"\xff.nrrd")).arg("-o").arg(name(b"\xfe.lloom"))).succeeded();
    for rest in [&["verify"][..], &["info"]] {
        run(lightloom(rest).arg(name(b"\xfe.lloom"))).succeeded();
    }
    // Scenes are named by text.
    let mut command = lightloom(&["simulate", "--display", "desk8", "--out", &bench.path("out")]);
    run(command.arg(name(b"\xfe.lloom"))).refused(&[".lloom is none: rename it"]);
}

/// The parser's own complaints of what is missing would be as many as slices.
#[test]
fn dicom_without_a_meta_group_is_read_in_silence() {
    let bench = Bench::new();
    let bytes = fs::read(test_data("dicom/padded.dcm")).unwrap();
    let elements = bytes.windows(6).position(|part| part == b"\x08\0\x16\0UI").unwrap();
    fs::write(bench.at("bare.dcm"), &bytes[elements..]).unwrap();
    let ran = bench.import(&bench.path("bare.dcm"), &["--spacing-mm", "1,1,1"]).succeeded();
    assert!(!ran.stderr.contains("missing"), "{ran:?}");
}

/// A name that would set the title of a terminal, and colours.
#[test]
fn no_command_of_a_terminal_is_printed() {
    let bench = Bench::new();
    let name = "\u{1b}]0;title\u{7}\u{1b}[31m.nrrd";
    let ran = bench.import(&bench.path(name), &[]);
    ran.refused(&["title", ".nrrd"]);
    assert!(!ran.stderr.contains(['\u{1b}', '\u{7}']), "{ran:?}");
    fs::copy(test_data("short.nrrd"), bench.at(name)).unwrap();
    bench.import(&bench.path(name), &[]).succeeded();
    let info = run(&mut lightloom(&["info", &bench.path("out.lloom")])).succeeded();
    assert!(info.stdout.contains("title") && !info.stdout.contains(['\u{1b}', '\u{7}']), "{info:?}");
}

#[test]
fn an_interrupted_export_leaves_nothing() {
    let bench = Bench::new();
    let store = bench.path("v.lloom");
    run(&mut lightloom(&["import", "procedural:sparse-vessels@700", "-o", &store, "--quiet"])).succeeded();
    for (out, signal) in [("a.nrrd", "INT"), ("a.zarr", "TERM")] {
        let running = start(&mut lightloom(&["export", &store, &bench.path(out)]));
        machine::wait_for("its working file", || fs::read_dir(bench.folder.path()).unwrap().count() > 1);
        let process = running.process().to_string();
        assert!(Command::new("kill").args(["-s", signal, &process]).status().unwrap().success());
        let limit = running.age() + STOPS_WITHIN;
        let ran = running.finish(limit);
        ran.refused(&[out, "stopped: nothing was written"]);
        assert!(ran.code.is_some_and(|code| code >= 128), "{ran:?}");
        assert_eq!(fs::read_dir(bench.folder.path()).unwrap().count(), 1, "{out}");
    }
}
