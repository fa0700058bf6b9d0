//! Looks: which one a volume gets, what it shows, and the scene that is saved of it.

use frontend::scene::{LookName, choose, read_values};
use lightloom_tests::data;
use lightloom_tests::program::{
    Ran, assert_same, files, lightloom, pictures, run, scene_of_skins, small_display, test_data,
};
use std::fs;
use std::path::{Path, PathBuf};

/// Voxels along an edge of the phantom.
const EDGE: i32 = 40;

/// A head of 14 cm in Hounsfield units: a brain in a skull under a scalp, in air, and beyond the circle that a scanner sees what
/// it writes there.
fn phantom() -> Vec<u8> {
    let centred = |i: i32| f64::from(i) - 0.5 * f64::from(EDGE - 1);
    let voxel = |i: i32| {
        let [x, y, z] = [i % EDGE, i / EDGE % EDGE, i / (EDGE * EDGE)].map(centred);
        let hounsfield: i16 = match (x * x + y * y + z * z).sqrt() {
            r if r < 12.0 => 35,
            r if r < 14.0 => 900,
            r if r < 17.0 => 45,
            _ if x.hypot(z) < 19.5 => -1000,
            _ => -2000,
        };
        hounsfield.to_le_bytes()
    };
    (0..EDGE.pow(3)).flat_map(voxel).collect()
}

struct Bench {
    folder: tempfile::TempDir,
    display: String,
}

impl Bench {
    /// With the phantom as `ct.lloom`.
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let bench = Self { display: small_display(folder.path()), folder };
        fs::write(bench.path("ct.raw"), phantom()).unwrap();
        bench.import("ct.raw", &["40,40,40", "int16", "4,4,4"]);
        bench
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_string_lossy().into_owned()
    }

    /// Imports raw voxels into a store of the same stem.
    fn import(&self, raw: &str, [dims, kind, spacing]: &[&str; 3]) -> String {
        let (input, store) = (self.path(raw), self.path(raw).replace(".raw", ".lloom"));
        let layout = ["--raw-dims", dims, "--raw-type", kind, "--raw-spacing-mm", spacing];
        let arguments = ["import", &input, "-o", &store, "--bits", "16", "--quiet"];
        run(&mut lightloom(&[&arguments[..], &layout].concat())).succeeded();
        store
    }

    fn scene(&self, name: &str, text: &str) -> String {
        fs::write(self.path(name), text).unwrap();
        self.path(name)
    }

    /// Draws into the folder of this name.
    fn simulate(&self, scene: &str, out: &str, more: &[&str]) -> Ran {
        let out = self.path(out);
        let fixed = ["simulate", scene, "--display", &self.display, "--device", "cpu", "--out", &out];
        run(&mut lightloom(&[&fixed[..], &["--eye", "0,0,1.2"], more].concat()))
    }

    fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}

/// Brightness of an eye's pixels, from 0 to 255.
fn brightness(out: &Path) -> Vec<u8> {
    image::open(out.join("frame-0000/eye-0.png")).unwrap().to_luma8().into_raw()
}

/// The part of the pixels that are at least so bright.
fn share(pixels: &[u8], least: u8) -> f64 {
    pixels.iter().filter(|&&pixel| pixel >= least).count() as f64 / pixels.len() as f64
}

#[test]
fn real_volumes_choose_their_looks() {
    for (store, expected) in [(data::cranium(), LookName::CtSkinBone), (data::head_mri(), LookName::Mr)] {
        let Some(store) = store else { continue };
        let choice = choose(&read_values(&store));
        assert_eq!(choice.name, expected, "{choice}");
    }
    assert_eq!(choose(&read_values(&data::vessels())).name, LookName::Fluorescence);
    assert_eq!(choose(&read_values(&data::noise())).name, LookName::Tomogram);
}

/// Values of a ramp, which are no Hounsfield units by themselves.
#[test]
fn a_store_keeps_what_its_file_says_and_the_look_follows() {
    let bench = Bench::new();
    let store = bench.path("series.lloom");
    run(&mut lightloom(&["import", &test_data("dicom/rescaled"), "-o", &store, "--quiet"])).succeeded();
    let info = run(&mut lightloom(&["info", &store])).succeeded();
    assert!(info.stdout.contains("modality            CT"), "{info:?}");
    let drawn = bench.simulate(&store, "series", &[]).succeeded();
    let said = drawn.stdout + &drawn.stderr;
    assert!(said.contains("look `ct-skin-bone`: its file says that it is CT"), "{said}");
}

/// What spanned the whole range of values showed the air of the scanner's circle as a blue box.
#[test]
fn a_ct_shows_a_head_and_not_a_box() {
    let bench = Bench::new();
    let ran = bench.simulate(&bench.path("ct.lloom"), "out", &[]).succeeded();
    assert!(ran.stdout.starts_with("look `ct-skin-bone`: its values are Hounsfield units\n"), "{ran:?}");
    let spanning = "[volume]\nsource = 'ct.lloom'\n[optics]\nextinction_unit = 'per_metre'\n\
                    extinction = [[-1565, 0], [-985, 9], [-260, 41], [320, 207], [900, 740]]\n\
                    colour = [[-1565, 0.03, 0.2, 0.55], [-985, 0.1, 0.45, 0.6], [-260, 0.8, 0.5, 0.25], [900, 1, 0.95, 0.9]]\n\
                    [light]\n";
    bench.simulate(&bench.scene("spanning.toml", spanning), "spanning", &["--quiet"]).succeeded();
    let [shown, spanned] = ["out", "spanning"].map(|out| brightness(&bench.out(out)));
    // The volume takes three quarters of the screen's height and nine sixteenths of its width.
    let disc = |voxels: f64| 0.75 * 0.5625 * std::f64::consts::FRAC_PI_4 * (voxels / f64::from(EDGE)).powi(2);
    let (head, skull) = (disc(34.0), disc(28.0));
    let [lit, bright] = [8, 150].map(|least| share(&shown, least));
    assert!((lit / head - 1.0).abs() < 0.15, "{lit} of {head}");
    assert!((bright / skull - 1.0).abs() < 0.3, "{bright} of {skull}");
    let lit = share(&spanned, 8);
    assert!(lit > 1.4 * head, "{lit} of {head}");
}

#[test]
fn a_saved_scene_makes_the_same_pictures() {
    let bench = Bench::new();
    let moving = "look = 'ct-bone'\n[volume]\nsource = 'ct.lloom'\n[placement]\nlongest_m = 0.31\nrotation_deg = [11, 23, 47]\n\
                  [light]\ntoward = [0.1, 0.7, 0.3]\n[frames]\ncount = 2\nrate_hz = 3\n\
                  [[keyframe]]\ntime_s = 0.1\nrotation_deg = [10, 20, 30]\n[[keyframe]]\ntime_s = 0.7\nrotation_deg = [70, 20, 10]\n";
    let skins = scene_of_skins("procedural:shells@48", "[quality]\npreset = 'fine'\n");
    fs::create_dir(bench.path("elsewhere")).unwrap();
    let runs = [
        (bench.path("ct.lloom"), "saved.toml", &[][..]),
        (bench.path("ct.lloom"), "elsewhere/saved.toml", &["--look", "scalar", "--quality", "draft"][..]),
        (bench.scene("moving.toml", moving), "elsewhere/moving.toml", &[]),
        (bench.scene("skins.toml", &skins), "skins-2.toml", &["--quality", "default"]),
        ("procedural:shells@48".to_owned(), "shells.toml", &[]),
        ("procedural:shells@48".to_owned(), "shells-mr.toml", &["--look", "mr"]),
    ];
    for (scene, saved, more) in runs {
        let path = bench.path(saved);
        bench.simulate(&scene, "first", &[&["--save-scene", &path], more].concat()).succeeded();
        bench.simulate(&path, "second", &["--quiet"]).succeeded();
        let [first, second] = ["first", "second"].map(|out| pictures(&bench.out(out)));
        assert_same(saved, &second, &first);
        // What is saved of what was saved says the same.
        let again = bench.path("again.toml");
        bench.simulate(&path, "second", &["--save-scene", &again]).succeeded();
        let [text, again] = [&path, &again].map(|path| fs::read_to_string(path).unwrap());
        let without_source = |text: &str| {
            let lines = text.lines().filter(|line| !line.starts_with("source"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(without_source(&again), without_source(&text), "{saved}");
    }
}

#[test]
fn a_scene_is_saved_only_where_it_can_be_read() {
    let bench = Bench::new();
    let scene = bench.scene("own.toml", "[volume]\nsource = 'ct.lloom'\n");
    let before = fs::read(&scene).unwrap();
    let refused = |to: &str, parts: &[&str]| {
        bench.simulate(&scene, "out", &["--save-scene", to]).refused(parts);
        assert!(!bench.out("out").exists());
    };
    refused(&scene, &["own.toml", "another file"]);
    refused(&bench.path("saved.scene"), &["saved.scene", ".toml"]);
    assert!(fs::read(&scene).unwrap() == before && !bench.out("saved.scene").exists());
}

#[test]
fn a_scene_s_own_optics_win() {
    let bench = Bench::new();
    let scene = bench.scene("skins.toml", &scene_of_skins("procedural:shells@48", ""));
    bench.simulate(&scene, "plain", &[]).succeeded();
    let ran = bench.simulate(&scene, "asked", &["--look", "mr"]).succeeded();
    assert!(ran.stderr.contains("[optics]") && ran.stderr.contains("--look mr"), "{ran:?}");
    assert!(!ran.stdout.contains("look `"), "{ran:?}");
    assert_same("--look", &pictures(&bench.out("asked")), &pictures(&bench.out("plain")));
}

#[test]
fn a_scene_may_name_its_look() {
    let bench = Bench::new();
    let with = |head: &str, rest: &str| format!("{head}\n[volume]\nsource = 'ct.lloom'\n{rest}");
    let scene = bench.scene("bone.toml", &with("look = 'ct-bone'", ""));
    let ran = bench.simulate(&scene, "scene", &[]).succeeded();
    assert!(ran.stdout.contains("look `ct-bone`: it was asked for"), "{ran:?}");
    bench.simulate(&bench.path("ct.lloom"), "store", &["--look", "ct-bone"]).succeeded();
    assert_same("a named look", &pictures(&bench.out("scene")), &pictures(&bench.out("store")));
    let ran = bench.simulate(&scene, "over", &["--look", "mr"]).succeeded();
    assert!(ran.stdout.contains("look `mr`: it was asked for"), "{ran:?}");
    for (text, parts) in [
        (with("look = 'ct-bon'", ""), &["line 1", "`look`", "did you mean `ct-bone`?"][..]),
        (
            with(
                "look = 'mr'",
                "[optics]\nextinction_unit = 'per_metre'\nextinction = [[0, 1]]\ncolour = [[0, 1, 1, 1]]\n",
            ),
            &["line 1", "`look`", "[optics]"],
        ),
    ] {
        bench.simulate(&bench.scene("wrong.toml", &text), "out", &[]).refused(parts);
    }
    let ran = bench.simulate(&bench.path("ct.lloom"), "out", &["--look", "ct-skn-bone"]);
    assert!(ran.code != Some(0) && ran.stderr.contains("'ct-skin-bone'"), "{ran:?}");
}

#[test]
fn a_page_shows_every_look() {
    let bench = Bench::new();
    let (store, out) = (bench.path("ct.lloom"), bench.path("looks"));
    let arguments = ["looks", &store, "-o", &out, "--display", &bench.display, "--device", "cpu"];
    let ran = run(&mut lightloom(&arguments)).succeeded();
    assert!(ran.stdout.contains("look `ct-skin-bone`") && ran.stdout.contains("9 looks"), "{ran:?}");
    let made = files(Path::new(&out));
    let page = String::from_utf8_lossy(&made["looks.html"]).into_owned();
    for name in LookName::ALL {
        assert!(
            made.contains_key(&format!("look-{name}.png")) && page.contains(&format!("<b>{name}</b>")),
            "{name}"
        );
    }
    assert_eq!(made.len(), 10, "{:?}", made.keys());
    assert!(page.contains("chosen: its values are Hounsfield units") && page.contains("does not fit: "));
    assert_ne!(made["look-ct-bone.png"], made["look-ct-skin-bone.png"]);
    run(&mut lightloom(&["looks", &bench.path("no.lloom"), "-o", &out])).refused(&["no.lloom"]);
}
