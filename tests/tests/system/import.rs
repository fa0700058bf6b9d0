//! From a volume file to pictures and a report, as a user goes.

use lightloom_tests::data::cranium_raw;
use lightloom_tests::processes::{is_there, resident_mib};
use lightloom_tests::program::{Ran, files, lightloom, report, run, small_display, start, test_data};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// An sRGB code above which a pixel is lit for the eye.
const LIT: u8 = 16;

fn import(input: &str, store: &str, more: &[&str]) -> Value {
    let arguments = [&["import", input, "-o", store, "--json"], more].concat();
    let ran = run(&mut lightloom(&arguments)).succeeded();
    serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else")
}

fn simulate(scene: &str, display: &str, out: &Path, more: &[&str]) -> Ran {
    let out = out.to_string_lossy().into_owned();
    let fixed = ["simulate", scene, "--display", display, "--device", "cpu", "--out", &out];
    run(&mut lightloom(&[&fixed[..], more].concat())).succeeded()
}

/// The part of a picture's pixels that is lit.
fn lit(path: &Path) -> f64 {
    let picture = image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgb8();
    let lit = picture.pixels().filter(|pixel| pixel.0.iter().any(|code| *code > LIT)).count();
    lit as f64 / f64::from(picture.width() * picture.height())
}

/// The files of a run are there and show something; its numbers make sense.
fn check(out: &Path, pixels: u64, least_lit: f64) {
    let report = report(out);
    let frame = &report["frames"][0];
    let named =
        |key: &str| frame[key].as_array().unwrap().iter().map(|name| name.as_str().unwrap().to_owned());
    for name in named("pictures").chain(named("eye_views")) {
        let share = lit(&out.join(&name));
        assert!(share > least_lit, "{name}: {share} of it is lit");
    }
    assert!(lit(&out.join("contact-sheet.png")) > 0.5 * least_lit);
    check_numbers(&report, pixels);
    check_page(&fs::read_to_string(out.join("report.html")).unwrap());
    let working: Vec<_> = files(out).into_keys().filter(|name| name.contains(".part")).collect();
    assert!(working.is_empty(), "{working:?}");
}

fn check_numbers(report: &Value, pixels: u64) {
    let total = &report["total"];
    let number = |key: &str| total[key].as_u64().unwrap_or_else(|| panic!("{key} in {total}"));
    assert_eq!(total["complete"], true, "{total}");
    assert_eq!(report["display"]["pixels"], pixels);
    // Each pixel once, and once more the tiles that missed something and the few rays of the coarse look.
    assert!(number("rays") > pixels && number("rays") <= 2 * pixels, "{total}");
    assert!(number("samples") > number("rays") / 10, "{total}");
    let union = number("working_set_union");
    assert!(0 < union && union <= number("bricks_resident"), "{total}");
    // A GPU casts views together, and then knows no sum of theirs; drivers in software do not.
    let adapter = report["backends"][0]["adapter"].as_str().unwrap();
    if adapter.starts_with("cpu") || adapter.contains("llvmpipe") {
        assert!(union <= number("working_set_sum"), "{total}");
    }
    assert!(number("bricks_resident") <= number("bricks_loaded"), "{total}");
    assert!(
        report["wall_ms"].as_f64().unwrap() > 0.0 && report["peak_memory_bytes"].as_u64() > Some(1 << 20)
    );
}

/// A page that shows the same on a machine without network and without the run's folder.
fn check_page(page: &str) {
    for outside in
        ["http://", "https://", "src=\"frame", "src=\"contact", "<link", "<script", "@import", "url("]
    {
        assert!(!page.contains(outside), "the page needs {outside}");
    }
    assert!(page.contains("src=\"data:image/png;base64,") && page.ends_with("</html>\n"));
}

/// The small volumes are ramps along x, y and z, of 5 × 6 × 4 voxels.
#[test]
fn small_files_of_every_format() {
    for name in
        ["ushort.nii", "short_big.nii.gz", "short.nrrd", "spacings_gzip.nhdr", "short.mhd", "double.mha"]
    {
        let folder = tempfile::tempdir().unwrap();
        let (store, out) = (folder.path().join("ramp.lloom"), folder.path().join("out"));
        let store = store.to_string_lossy().into_owned();
        let said = import(&test_data(name), &store, &["--bits", "16"]);
        assert_eq!(said["dims"], serde_json::json!([5, 6, 4]), "{name}");
        assert_eq!(said["value_range"], serde_json::json!([0.0, 354.0]), "{name}");
        simulate(&store, &small_display(folder.path()), &out, &["--eye", "0,0,1.2", "--quiet"]);
        check(&out, 4 * 96 * 72, 0.01);
    }
}

/// The cranium of the examples, in the scene that comes with the program.
#[test]
fn a_real_head_on_a_desk() {
    let folder = tempfile::tempdir().unwrap();
    let Some(raw) = cranium_raw(folder.path()) else { return };
    let store = folder.path().join("cranium.lloom").to_string_lossy().into_owned();
    let layout = ["--raw-dims", "256,256,108", "--raw-type", "int16", "--raw-spacing-mm", "0.957,0.957,1.5"];
    let said = import(&raw.to_string_lossy(), &store, &layout);
    assert_eq!(said["dims"], serde_json::json!([256, 256, 108]));
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../frontend/scenes/cranium.toml");
    let beside = folder.path().join("cranium.toml");
    fs::copy(scene, &beside).unwrap();
    let out = folder.path().join("out");
    simulate(&beside.to_string_lossy(), "desk8", &out, &["--eye", "0,0,1.2", "--quiet"]);
    check(&out, 8 * 320 * 240, 0.05);
}

#[test]
fn what_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let (display, out) = (small_display(folder.path()), folder.path().join("out"));
    let print = |more: &[&str]| simulate("procedural:shells@32", &display, &out, more);
    let quiet = print(&["--quiet"]);
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
    let json = print(&["--json"]);
    let printed: Value = serde_json::from_str(&json.stdout).expect("--json prints JSON and nothing else");
    assert_eq!((printed, json.stderr.as_str()), (report(&out), ""));
    let plain = print(&[]);
    let lines: Vec<_> = plain.stdout.lines().collect();
    assert!(
        lines.len() == 1 && lines[0].contains("4 pictures") && lines[0].contains("report.html"),
        "{plain:?}"
    );
    assert_eq!(plain.stderr, "");

    let store = folder.path().join("a.lloom").to_string_lossy().into_owned();
    let quiet =
        run(&mut lightloom(&["import", &test_data("short.nrrd"), "-o", &store, "--quiet"])).succeeded();
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
    let displays = run(&mut lightloom(&["displays"])).succeeded();
    assert!(displays.stdout.contains("holo72") && displays.stdout.contains("desk8"), "{}", displays.stdout);
}

/// Voxels beyond what the header says are no error, and are told of in plain text where nobody sees colours.
#[test]
fn warnings_are_plain_text_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let longer = folder.path().join("longer.nrrd");
    let mut bytes = fs::read(test_data("short.nrrd")).unwrap();
    bytes.extend([0; 100]);
    fs::write(&longer, bytes).unwrap();
    let store = folder.path().join("a.lloom").to_string_lossy().into_owned();
    let ran = run(&mut lightloom(&["import", &longer.to_string_lossy(), "-o", &store])).succeeded();
    assert!(ran.stderr.contains("more bytes than the header says"), "{ran:?}");
    assert!(ran.stderr.contains("longer.nrrd") && !ran.stderr.contains('\u{1b}'), "{ran:?}");
}

/// Voxels of two bytes along each axis: more of them than an import of little memory holds.
const LARGE: [usize; 3] = [512, 512, 320];
/// The memory that it is given, and what comes on top of it, MiB: a quarter more than the help's "some 100".
const GIVEN_AND_ON_TOP_MIB: [f64; 2] = [16.0, 125.0];

#[test]
fn an_import_holds_no_more_memory_than_its_help_says() {
    let help = run(&mut lightloom(&["import", "--help"])).succeeded().stdout;
    assert!(help.contains("some 100 MiB come on top"), "{help}");
    let [given, on_top] = GIVEN_AND_ON_TOP_MIB;
    let bytes: Vec<u8> = (0..LARGE.iter().product::<usize>() as u32)
        .flat_map(|i| ((i.wrapping_mul(2_654_435_761) >> 20) as u16).to_le_bytes())
        .collect();
    assert!(bytes.len() as f64 > (given + on_top) * f64::from(1 << 20), "all of it at once would pass");
    let folder = tempfile::tempdir().unwrap();
    let (raw, store) = (folder.path().join("large.raw"), folder.path().join("large.lloom"));
    fs::write(&raw, bytes).unwrap();
    let (raw, store, dims) = (raw.to_str().unwrap(), store.to_str().unwrap(), LARGE.map(|n| n.to_string()));
    let memory = given.to_string();
    let layout = ["--raw-dims", &dims.join(","), "--raw-type", "uint16", "--raw-endian", "little"];
    let arguments = [&["import", raw, "-o", store, "--memory", &memory], &layout[..]].concat();
    let import = start(&mut lightloom(&arguments));
    let mut most = 0.0_f64;
    while is_there(import.process()) {
        most = most.max(resident_mib(import.process()));
        sleep(Duration::from_millis(1));
    }
    import.finish(Duration::from_secs(60)).succeeded();
    println!("{most:.0} MiB");
    assert!(most > 0.0 && most <= given + on_top, "{most} MiB");
}
