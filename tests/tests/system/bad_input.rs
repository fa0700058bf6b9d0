//! What cannot work is refused with one sentence that names the thing and says what to do, and leaves no file behind.

use lightloom_tests::program::{
    SMALL_DISPLAY, cluster, files, lightloom, report, run, small_display, test_data,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A refusal takes a moment, also where a launcher has to end its ranks.
const A_MOMENT: std::time::Duration = std::time::Duration::from_secs(15);

/// A folder to spoil things in.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_string_lossy().into_owned()
    }

    /// A file of the folder with this content.
    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        fs::write(self.path(name), content).unwrap();
        self.path(name)
    }

    /// A store of 5 × 6 × 4 voxels.
    fn store(&self, name: &str) -> String {
        run(&mut lightloom(&["import", &test_data("short.nrrd"), "-o", &self.path(name), "--quiet"]))
            .succeeded();
        self.path(name)
    }

    /// `simulate` with these arguments is refused, and no file appears in its output folder.
    #[track_caller]
    fn simulate_refused(&self, arguments: &[&str], parts: &[&str]) {
        let out = self.path("out");
        let arguments = [&["simulate", "--device", "cpu", "--out", &out], arguments].concat();
        run(&mut lightloom(&arguments)).refused(parts);
        assert!(files(Path::new(&out)).is_empty(), "{:?}", files(Path::new(&out)).keys());
    }

    /// The small display with one piece of its text replaced is refused.
    #[track_caller]
    fn display_refused(&self, piece: &str, by: &str, parts: &[&str]) {
        assert!(SMALL_DISPLAY.contains(piece), "the display has no {piece}");
        let display = self.write("spoiled.toml", SMALL_DISPLAY.replace(piece, by));
        self.simulate_refused(&["procedural:shells@16", "--display", &display], parts);
    }

    /// A scene file with this text is refused; `parts` are looked for after its path.
    #[track_caller]
    fn scene_refused(&self, text: &str, parts: &[&str]) {
        let scene = self.write("scene.toml", text);
        let display = small_display(self.folder.path());
        self.simulate_refused(&[&scene, "--display", &display], &[&[scene.as_str()], parts].concat());
    }

    /// `import` of this file is refused, and nothing but the input is in the folder then.
    #[track_caller]
    fn import_refused(&self, input: &str, parts: &[&str]) {
        let before = files(self.folder.path());
        run(&mut lightloom(&["import", input, "-o", &self.path("out.lloom")])).refused(parts);
        assert!(files(self.folder.path()) == before, "{:?}", files(self.folder.path()).keys());
    }
}

/// A text file of the test data with its binary tail, one piece replaced.
fn with(name: &str, piece: &str, by: &str) -> Vec<u8> {
    let bytes = fs::read(test_data(name)).unwrap();
    let at = bytes.windows(piece.len()).position(|w| w == piece.as_bytes()).expect("the piece is there");
    [&bytes[..at], by.as_bytes(), &bytes[at + piece.len()..]].concat()
}

#[test]
fn a_missing_volume_file() {
    let bench = Bench::new();
    let missing = bench.path("nowhere.nrrd");
    bench.import_refused(&missing, &[&missing, "check the path"]);
}

#[test]
fn files_cut_short() {
    let bench = Bench::new();
    let cut = |name: &str| {
        let bytes = fs::read(test_data(name)).unwrap();
        bench.write(name, &bytes[..bytes.len() - 100])
    };
    for name in ["short.nrrd", "ushort_gzip.nrrd", "ushort.nii", "short_big.nii.gz", "double.mha"] {
        let input = cut(name);
        bench.import_refused(&input, &[&input, "copy"]);
    }
}

#[test]
fn headers_that_promise_more_than_there_is() {
    let bench = Bench::new();
    let nrrd = bench.write("lie.nrrd", with("short.nrrd", "sizes: 5 6 4", "sizes: 50 60 40"));
    bench.import_refused(&nrrd, &[&nrrd, "240000 bytes", "correct its header"]);
    let huge = bench
        .write("huge.nrrd", with("short.nrrd", "sizes: 5 6 4", "sizes: 4000000000 4000000000 4000000000"));
    bench.import_refused(&huge, &[&huge, "from 1 to 1048576"]);
    // As large as dimensions may be: it must find the lie before it takes memory for a slab.
    let large =
        bench.write("large.nrrd", with("short.nrrd", "sizes: 5 6 4", "sizes: 1048576 1048576 1048576"));
    bench.import_refused(&large, &[&large, "too short"]);
    let packed = bench
        .write("packed.nrrd", with("ushort_gzip.nrrd", "sizes: 5 6 4", "sizes: 1048576 1048576 1048576"));
    bench.import_refused(&packed, &[&packed]);
}

#[test]
fn raw_files_of_another_size() {
    let bench = Bench::new();
    let raw = test_data("ushort_big.raw");
    let arguments =
        ["import", &raw, "-o", &bench.path("out.lloom"), "--raw-dims", "5,6,5", "--raw-type", "uint16"];
    run(&mut lightloom(&arguments)).refused(&[&raw, "240 bytes", "correct dimensions"]);
    assert!(files(bench.folder.path()).is_empty());
}

#[test]
fn files_that_are_no_volumes() {
    let bench = Bench::new();
    let text = bench.write("letter.txt", "Dear reader,\n");
    bench.import_refused(&text, &[&text, "not known", "give a DICOM, TIFF, NRRD"]);
    bench.import_refused(&bench.path(""), &[&bench.path("")]);
}

#[test]
fn stores_of_another_version() {
    let bench = Bench::new();
    let store = bench.store("later.lloom");
    let mut bytes = fs::read(&store).unwrap();
    bytes[8] = 99;
    fs::write(&store, bytes).unwrap();
    bench.simulate_refused(&[&store], &[&store, "version 99", "import the volume again"]);
}

/// Cut anywhere: within the magic, the header, the table and the bricks.
#[test]
fn stores_cut_short() {
    let bench = Bench::new();
    let bytes = fs::read(bench.store("whole.lloom")).unwrap();
    for length in [0, 5, 60, 130, 170, bytes.len() - 1] {
        let store = bench.write("cut.lloom", &bytes[..length]);
        bench.simulate_refused(&[&store], &[&store, "import the volume"]);
    }
}

/// The bricks' contents are not checked when a store opens: the sentence then comes from a back-end that draws.
#[test]
fn stores_with_a_spoiled_brick() {
    let bench = Bench::new();
    let store = bench.store("spoiled.lloom");
    let mut bytes = fs::read(&store).unwrap();
    let length = bytes.len();
    bytes[length - 40..].fill(0xff);
    fs::write(&store, bytes).unwrap();
    let display = small_display(bench.folder.path());
    bench.simulate_refused(&[&store, "--display", &display], &[&store, "damaged", "back-end 0"]);
}

#[test]
fn scenes_that_name_a_missing_store() {
    let bench = Bench::new();
    let scene = bench.write("scene.toml", "[volume]\nsource = 'nowhere.lloom'\n");
    bench.simulate_refused(&[&scene], &[&bench.path("nowhere.lloom"), "lightloom import"]);
    bench.simulate_refused(&[&bench.path("no.toml")], &[&bench.path("no.toml")]);
    bench.simulate_refused(&[&bench.path("no.lloom")], &[&bench.path("no.lloom"), "lightloom import"]);
    bench.simulate_refused(&["procedural:nothing"], &["procedural volume `nothing`", "use one of"]);
}

#[test]
fn transfer_functions_that_are_no_numbers() {
    let bench = Bench::new();
    let scene = |extinction: &str, colour: &str| {
        format!(
            "[volume]\nsource = 'procedural:shells@16'\n[optics]\nextinction_unit = 'per_metre'\n\
             extinction = {extinction}\ncolour = {colour}\n"
        )
    };
    let (steady, white) = ("[[0, 1]]", "[[0, 1, 1, 1]]");
    for wrong in ["[[0, 1], [0.5, nan]]", "[[0, 1], [0.5, inf]]", "[[0, 1], [nan, 1]]", "[[0, 1], [0.5, -1]]"]
    {
        let place = ["line 5", "`optics.extinction`", "control point 1", "correct that point"];
        bench.scene_refused(&scene(wrong, white), &place);
    }
    bench
        .scene_refused(&scene(steady, "[[0, 1, nan, 1]]"), &["line 6", "`optics.colour`", "control point 0"]);
    bench.scene_refused(&scene("[]", white), &["`optics.extinction`", "give at least one"]);
    bench.scene_refused("[volume\n", &["line 1"]);
}

#[test]
fn displays_that_cannot_be() {
    let bench = Bench::new();
    let path = bench.path("spoiled.toml");
    let in_plane = [path.as_str(), "`to_m`", "in the screen plane", "move it"];
    bench.display_refused("to_m = [0.36, 0.0, -1.5]", "to_m = [0.36, 0.0, 0.0]", &in_plane);
    bench.display_refused("count = 4", "count = 0", &[&path, "`count` is 0", "from 1 to"]);
    bench.display_refused(
        "observer_m = [0.0, 0.0, 1.2]",
        "observer_m = [0.0, 0.0, -1.2]",
        &[&path, "`observer_m`", "before the screen"],
    );
    bench.display_refused("eta = 1.0", "eta = nan", &[&path, "`eta`"]);
    let (before, _) = SMALL_DISPLAY.split_once("[projector_line]").unwrap();
    let none = bench.write("none.toml", before);
    let parts = [none.as_str(), "no projectors", "add"];
    bench.simulate_refused(&["procedural:shells@16", "--display", &none], &parts);
}

#[test]
fn displays_that_nobody_knows() {
    let bench = Bench::new();
    let display = |display: &str, parts: &[&str]| {
        bench.simulate_refused(&["procedural:shells@16", "--display", display], parts);
    };
    display("desk9", &["`desk9`", "holo72, desk8"]);
    let missing = bench.path("nowhere.toml");
    display(&missing, &[&missing, "readable"]);
}

#[test]
fn eyes_that_cannot_see_the_screen() {
    let bench = Bench::new();
    for z in ["0", "-1.2"] {
        let eye = format!("--eye=0,0,{z}");
        let parts = ["the eye is at", "put it before the screen"];
        bench.simulate_refused(&["procedural:shells@16", "--display", "desk8", &eye], &parts);
    }
}

#[test]
fn more_back_ends_than_projectors() {
    let bench = Bench::new();
    let display = small_display(bench.folder.path());
    let arguments = ["procedural:shells@16", "--display", &display, "--backends", "5"];
    bench.simulate_refused(&arguments, &["4 projectors among 5 back-ends", "start from 1 to 4"]);
}

#[test]
fn a_cache_of_nothing() {
    let bench = Bench::new();
    let display = small_display(bench.folder.path());
    let arguments = ["procedural:shells@16", "--display", &display, "--cache-mib", "0"];
    bench.simulate_refused(&arguments, &["--cache-mib", "give a whole number from 1 to"]);
}

#[test]
fn frames_that_the_scene_does_not_have() {
    let bench = Bench::new();
    let arguments = ["procedural:shells@16", "--display", "desk8", "--frames", "0..2"];
    bench.simulate_refused(&arguments, &["0..2", "0..1", "give a part"]);
}

/// Places where not even root can make a folder or a file.
fn unwritable(bench: &Bench) -> [PathBuf; 2] {
    [PathBuf::from(bench.write("file", "content")), PathBuf::from("/proc")]
}

#[test]
fn output_folders_that_cannot_be_written() {
    let bench = Bench::new();
    let display = small_display(bench.folder.path());
    for place in unwritable(&bench) {
        let out = place.join("out").to_string_lossy().into_owned();
        let arguments =
            ["simulate", "procedural:shells@16", "--display", &display, "--device", "cpu", "--out", &out];
        run(&mut lightloom(&arguments)).refused(&[&out, "cannot write", "another folder"]);
    }
    assert_eq!(fs::read_to_string(bench.path("file")).unwrap(), "content");
}

#[test]
fn stores_that_cannot_be_written() {
    let bench = Bench::new();
    for place in unwritable(&bench) {
        let out = place.join("out.lloom").to_string_lossy().into_owned();
        let ran = run(&mut lightloom(&["import", &test_data("short.nrrd"), "-o", &out]));
        ran.refused(&[&out, "cannot write", "check the folder"]);
        assert!(!ran.stderr.contains(".lloom-"), "a working file is nothing to tell of: {}", ran.stderr);
    }
    let folder = bench.path("folder.lloom");
    fs::create_dir(&folder).unwrap();
    run(&mut lightloom(&["import", &test_data("short.nrrd"), "-o", &folder]))
        .refused(&[&folder, "cannot write"]);
}

/// A run that is refused takes nothing away from the one before it.
#[test]
fn a_refused_run_leaves_the_report_of_the_one_before() {
    let bench = Bench::new();
    let (display, out) = (small_display(bench.folder.path()), bench.path("out"));
    let arguments = [
        "simulate",
        "procedural:shells@16",
        "--display",
        &display,
        "--device",
        "cpu",
        "--out",
        &out,
        "--quiet",
    ];
    run(&mut lightloom(&arguments)).succeeded();
    let before = files(Path::new(&out));
    let wrong: [&[&str]; 3] = [&["--eye", "0,0,-1"], &["--backends", "5"], &["--frames", "3..4"]];
    for more in wrong {
        run(&mut lightloom(&[&arguments[..], more].concat())).refused(&[]);
        assert!(files(Path::new(&out)) == before, "{more:?}");
    }
    report(Path::new(&out));
}

/// A file system of a megabyte in memory, as root alone can make one.
struct SmallDisk {
    mount: PathBuf,
}

impl SmallDisk {
    fn new(mount: PathBuf) -> Option<Self> {
        fs::create_dir(&mount).unwrap();
        let options = ["-t", "tmpfs", "-o", "size=1m", "lightloom-test"];
        let status = Command::new("mount").args(options).arg(&mount).output();
        match status {
            Ok(output) if output.status.success() => Some(Self { mount }),
            _ => {
                println!("SKIPPED: a small file system cannot be mounted; run as root");
                None
            }
        }
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.mount).status();
    }
}

#[test]
fn a_disk_that_fills_up() {
    let bench = Bench::new();
    let Some(disk) = SmallDisk::new(bench.folder.path().join("disk")) else { return };
    let store = disk.mount.join("full.lloom").to_string_lossy().into_owned();
    let ran = run(&mut lightloom(&["import", "procedural:shells@128", "-o", &store, "--codec", "none"]));
    ran.refused(&[&store, "No space left", "free space"]);
    assert!(files(&disk.mount).is_empty(), "{:?}", files(&disk.mount).keys());

    let out = disk.mount.join("out").to_string_lossy().into_owned();
    // Linear pictures of this size take up to 100 kB each: some fit, not all.
    let display = bench.write("forty.toml", SMALL_DISPLAY.replace("count = 4", "count = 40"));
    let arguments = [
        "simulate",
        "procedural:shells@16",
        "--display",
        &display,
        "--device",
        "cpu",
        "--out",
        &out,
        "--exr",
    ];
    run(&mut lightloom(&arguments)).refused(&[&out, "No space left"]);
    let left = files(&disk.mount);
    assert!(!left.keys().any(|name| name.contains("report") || name.contains("part")), "{:?}", left.keys());
}

/// What the front-end alone can see must end the ranks that wait for it too.
#[test]
fn bad_input_ends_a_cluster() {
    let bench = Bench::new();
    let (display, out) = (small_display(bench.folder.path()), bench.path("out"));
    let ends = |scene: &str, more: &[&str], backends: u32, parts: &[&str]| {
        let arguments = ["simulate", scene, "--display", &display, "--device", "cpu", "--out", &out];
        let Some(mut command) = cluster(&[&arguments[..], more].concat(), backends) else { return };
        let ran = lightloom_tests::program::start(&mut command).finish(A_MOMENT);
        let sentences: Vec<_> = ran.stderr.lines().filter(|line| line.starts_with("lightloom")).collect();
        assert!(sentences.len() == 1 && parts.iter().all(|part| sentences[0].contains(part)), "{ran:?}");
        assert!(ran.code != Some(0) && !ran.stderr.contains("panicked"), "{ran:?}");
        assert!(files(Path::new(&out)).is_empty());
    };
    let missing = bench.path("nowhere.lloom");
    ends(&missing, &[], 2, &[&missing, "lightloom import"]);
    ends("procedural:shells@16", &["--eye", "0,0,-1"], 2, &["the eye is at"]);
    ends("procedural:shells@16", &[], 5, &["4 projectors among 5 back-ends"]);
    ends("procedural:shells@16", &["--cache-mib", "0"], 2, &["--cache-mib"]);
}
