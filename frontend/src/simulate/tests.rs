//! Laws of a run, with a source that draws gradients instead of volumes.

use super::*;
use crate::report::{self, BackendSummary, LEGEND};
use crate::scene::{Scene, VolumeFacts};
use bricks::volume::VolumeFrame;
use display_config::{Finish, Homography, Projector, Raster};
use glam::{DMat3, DVec3, UVec3};
use protocol::{DeviceInfo, Draw, DrawError, FrameReport, Pace, ProjectorImage, RenderEvent, Stages, Upkeep};
use renderer::output::EyePlan;
use std::path::Path;

const WIDTH: u32 = 40;
const HEIGHT: u32 = 30;

fn facts() -> VolumeFacts {
    let frame = VolumeFrame::of_voxels(DVec3::splat(1e-3));
    VolumeFacts { dims: UVec3::splat(64), frame, value_range: (0.0, 1.0) }
}

fn display(projectors: u32) -> Display {
    let (w, h) = (f64::from(WIDTH), f64::from(HEIGHT));
    let screen_from_pixel = Homography(DMat3::from_cols_array_2d(&[
        [1.6 / w, 0.0, 0.0],
        [0.0, -0.9 / h, 0.0],
        [-0.8, 0.45, 1.0],
    ]));
    let projector = |index: u32| Projector {
        name: format!("p{index}"),
        centre_in_display: DVec3::new(0.1 * f64::from(index), 0.0, -6.0),
        raster: Raster { width: WIDTH, height: HEIGHT, screen_from_pixel, output: None },
        backend: 0,
        finish: Finish::default(),
    };
    Display {
        name: "test".into(),
        width_m: 1.6,
        height_m: 0.9,
        pixel_size_m: 1.5e-3,
        angular_accuracy: 0.014,
        observer_in_display: DVec3::new(0.0, 0.0, 3.0),
        eta: 1.0,
        rate_hz: 60.0,
        projectors: (0..projectors).map(projector).collect(),
        adapters: Vec::new(),
    }
}

/// Draws a gradient per projector, last projector first, from two back-ends; stops on request.
struct Gradients {
    projectors: u32,
    fails_before: Option<u32>,
    skips: Option<u32>,
}

fn gradient(projector: u32) -> ProjectorImage {
    let pixels = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    let rgba =
        pixels.flat_map(|(x, y)| [x as f32 / 64.0, y as f32 / 64.0, projector as f32 / 8.0, 1.0]).collect();
    ProjectorImage { projector, width: WIDTH, height: HEIGHT, rgba }
}

fn account(frame: u32, backend: u32, projectors: Vec<u32>) -> FrameReport {
    FrameReport {
        frame,
        backend,
        caster: protocol::Caster::Rays,
        rays: 1200 * projectors.len() as u64,
        projectors,
        samples: 345_678,
        bricks_wanted: 20,
        bricks_resident: 27,
        bricks_loaded: 27,
        bytes_loaded: 27 << 15,
        working_set_union: 20,
        working_set_sum: Some(60),
        complete: backend == 0,
        shortfall: if backend == 0 { String::new() } else { "the cache is full <b>".into() },
        upkeep: None,
        refined: None,
        damaged_bricks: u64::from(backend),
        damaged: if backend == 0 { Vec::new() } else { vec!["brick 7 of <a.lloom> is damaged".into()] },
        stages: Stages { refine_ms: 2.0, load_ms: 14.0, upload_ms: 3.0, cast_ms: 90.0, readback_ms: 1.5 },
        total_ms: 110.5,
    }
}

/// What a live frame reports of a back-end's working set.
fn upkeep_of(frame: &FrameState, report: &FrameReport) -> Option<Upkeep> {
    let b = u64::from(report.backend);
    let (largest_deficit, mean_deficit) = (2.5 - b as f64, 0.5 + b as f64);
    let live = Upkeep {
        nodes: 73 + b,
        splits: 4,
        largest_deficit,
        mean_deficit,
        update_ms: 0.25,
        ..Upkeep::default()
    };
    (frame.pace != Pace::Complete).then_some(live)
}

/// What a live frame tells besides what it has in common with others, and what it does not.
fn told(frame: &FrameState, report: FrameReport) -> FrameReport {
    let working_set_sum = report.working_set_sum.filter(|_| frame.pace == Pace::Complete);
    FrameReport { upkeep: upkeep_of(frame, &report), working_set_sum, ..report }
}

impl Draw for Gradients {
    fn draw(
        &mut self,
        frame: &FrameState,
        sink: &mut dyn FnMut(RenderEvent),
    ) -> Result<Vec<FrameReport>, DrawError> {
        for projector in (0..self.projectors).rev() {
            if self.fails_before == Some(projector) {
                return Err(DrawError("back-end 0 died".into()));
            }
            sink(RenderEvent::Progress { done: 1, total: 2 });
            if self.skips != Some(projector) {
                sink(RenderEvent::Image(gradient(projector)));
            }
        }
        let half = self.projectors / 2;
        let shares = [(0..half).collect(), (half..self.projectors).collect()];
        let reports = shares.into_iter().zip(0..).map(|(share, b)| account(frame.index, b, share));
        Ok(reports.map(|report| told(frame, report)).collect())
    }
}

fn job(out: &Path, projectors: u32, frames: u32, weights: impl Fn(usize) -> f64 + Copy) -> Job {
    let (scene, display) = (Scene::load("procedural:shells@64").unwrap(), display(projectors));
    let all = move |_| (0..projectors as usize).map(move |p| (p, weights(p)));
    let plan = EyePlan::new(display.canonical_raster(), projectors as usize, all);
    let warning = Some("the eye at x = 2 m is outside the viewing zone".to_owned());
    Job {
        scene,
        facts: facts(),
        display,
        frames: 0..frames,
        remade: Default::default(),
        pace: Pace::Complete,
        debug: None,
        eyes: vec![Eye { position_m: DVec3::new(2.0, 0.0, 3.0), plan, warning }],
        out: out.to_owned(),
        exr: true,
        calibrated: false,
    }
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn source(projectors: u32) -> Gradients {
    Gradients { projectors, fails_before: None, skips: None }
}

#[test]
fn all_files_appear_and_the_report_adds_up() {
    let folder = tempfile::tempdir().unwrap();
    let job = job(folder.path(), 4, 2, |p| if p == 0 { 1.0 } else { 0.0 });
    Job::prepare_output(folder.path()).unwrap();
    let (json, html) = reports(&job, folder.path());
    assert_eq!(
        files(folder.path()),
        ["contact-sheet.png", "frame-0000", "frame-0001", "report.html", "report.json"]
    );
    let frame = files(&folder.path().join("frame-0001"));
    assert_eq!(frame.len(), 1 + 2 * (4 + 1), "{frame:?}");
    assert!(frame.contains(&"projector-03.exr".to_owned()) && frame.contains(&"eye-0.png".to_owned()));
    assert_eq!(json["total"]["rays"], 2 * 4 * 1200);
    assert_eq!(json["frames"][0]["total"]["complete"], false);
    assert_eq!(json["total"]["damaged_bricks"], 2);
    assert_eq!(json["total"]["damaged"], serde_json::json!(["brick 7 of <a.lloom> is damaged"]));
    assert_eq!(json["frames"][1]["pictures"][2], "frame-0001/projector-02.png");
    assert_eq!(json["eyes"][0]["projectors_seen"], 1);
    assert_eq!(json["backends"][1]["projectors"], serde_json::json!([2, 3]));
    assert_eq!(json["backends"][1]["adapter"], "fake");
    let why = "shared evenly, because the display file wires 1 back-end and 2 were started";
    assert_eq!(json["backends"][0]["why_these"], why);
    assert!(html.contains(why) && html.contains("2 to 3"));
    assert_eq!(json["total"]["casters"], serde_json::json!(["rays"]));
    assert!(html.contains("cast by"));
    assert!(json["peak_memory_bytes"].is_u64() || !Path::new("/proc/self/status").exists());
    assert_eq!(html.matches("<li>brick 7 of &lt;a.lloom&gt; is damaged</li>").count(), 1);
    assert!(html.contains("the cache is full &lt;b&gt;") && html.contains("outside the viewing zone"));
    assert!(!html.contains("src=\"frame") && !html.contains("http://") && !html.contains("https://"));
}

/// Runs a job and reads its reports: JSON and HTML.
fn reports(job: &Job, folder: &Path) -> (serde_json::Value, String) {
    let frames = job.run(&mut source(4), &mut Progress::new(false)).unwrap();
    let [adapter, reason, filter] = ["fake", "a test", "exact"].map(str::to_owned);
    let device = DeviceInfo { adapter, reason, filter, cache_bytes: 1 << 20 };
    let wiring = job.display.wiring(2).unwrap();
    let backends = BackendSummary::all(&wiring, vec![device; 2]);
    let report = job.report(backends, frames, Duration::from_secs(1)).unwrap();
    report::write(&report, folder).unwrap();
    let read = |name| std::fs::read_to_string(folder.join(name)).unwrap();
    (serde_json::from_str(&read(report::JSON)).unwrap(), read(report::HTML))
}

#[test]
fn the_report_tells_what_live_frames_did_to_the_working_set() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path(), 4, 2, |_| 0.25);
    let (json, html) = reports(&job, folder.path());
    assert_eq!(json["frames"][0]["total"]["working_set_sum"], 120);
    assert!(!html.contains("not counted"));
    assert!(json["frames"][0]["total"]["upkeep"].is_null() && !html.contains("Working set of live frames"));
    job.pace = Pace::Live { upload_bytes: 1 << 20, fade_s: 0.4 };
    let (json, html) = reports(&job, folder.path());
    let upkeep = &json["frames"][1]["total"]["upkeep"];
    assert_eq!((&upkeep["nodes"], &upkeep["splits"]), (&147.into(), &8.into()));
    // Both back-ends have cast as many rays: the largest is the first's, the mean that of 0.5 and 1.5.
    assert_eq!((&upkeep["largest_deficit"], &upkeep["mean_deficit"]), (&2.5.into(), &1.0.into()));
    assert_eq!(upkeep["update_ms"], 0.5);
    // The views of a live frame share one table of feedback.
    assert!(json["frames"][0]["total"]["working_set_sum"].is_null());
    assert!(json["total"]["working_set_sum"].is_null() && html.contains("<td>not counted</td>"));
    assert!(json["total"]["upkeep"].is_null(), "nodes do not add up over time");
    assert!(html.contains("Working set of live frames") && html.contains("<td>2.50 levels</td>"));
}

#[test]
fn the_report_tells_how_live_frames_went() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path(), 4, 3, |_| 0.25);
    let (json, html) = reports(&job, folder.path());
    assert!(json["live"].is_null() && !html.contains("Live frames"));
    job.pace = Pace::Live { upload_bytes: 1 << 20, fade_s: 0.4 };
    let mut moved = job.scene.frame(1, &job.display, &job.facts).unwrap();
    moved.display_from_volume.translation.x += 0.1;
    job.remade = [(1, moved.clone()), (2, FrameState { index: 2, ..moved })].into();
    let (json, html) = reports(&job, folder.path());
    let changes: Vec<_> = (0..3).map(|frame| json["frames"][frame]["changes"].as_bool()).collect();
    assert_eq!(changes, [Some(true), Some(true), Some(false)]);
    let live = &json["live"];
    for (key, expected) in
        [("frames", 3.0), ("changed", 2.0), ("with_detail", 3.0), ("complete", 0.0), ("mean_share", 1.0)]
    {
        assert_eq!(live[key].as_f64(), Some(expected), "{key}: {live}");
    }
    assert_eq!((&live["mean_deficit"], &live["largest_deficit"]), (&1.0.into(), &2.5.into()));
    assert_eq!((&live["drawing_ms"]["count"], &live["drawing_ms"]["max"]), (&3.into(), &110.5.into()));
    let (_, strip) = html.split_once("<h2>Live frames</h2>").unwrap();
    let strip = &strip[strip.find("<svg").unwrap()..strip.find("</svg>").unwrap() + 6];
    assert!(roxmltree::Document::parse(strip).is_ok(), "{strip}");
    let marks = |tone: u32| strip.matches(&format!("<line class=\"plot-line plot-t{tone}\"")).count();
    assert_eq!((marks(6), marks(1), marks(4)), (2, 3, 0));
}

#[test]
fn a_debug_view_comes_with_its_key() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path(), 4, 1, |_| 0.25);
    let without = |(json, html): (serde_json::Value, String)| {
        assert!(json["debug_view"].is_null() && !html.contains("Instead of the pictures"));
        assert!(!folder.path().join(LEGEND).exists());
    };
    without(reports(&job, folder.path()));
    job.debug = Some(DebugView::Samples);
    let (json, html) = reports(&job, folder.path());
    assert_eq!(json["debug_view"]["view"], "samples");
    assert_eq!(json["debug_view"]["scale"], serde_json::json!([0.0, 1024.0]));
    assert_eq!(json["debug_view"]["legend"], LEGEND);
    assert!(html.contains("samples that a ray took") && html.contains("0, 1, 4, 16, 64, 256, 1024+"));
    image::open(folder.path().join(LEGEND)).unwrap();
    // The key of an earlier run would explain other pictures.
    job.debug = None;
    without(reports(&job, folder.path()));
}

#[test]
fn an_eye_sees_the_weighted_mean_of_the_projectors() {
    let folder = tempfile::tempdir().unwrap();
    let job = job(folder.path(), 4, 1, |p| 0.25 * f64::from(p == 1) + 0.75 * f64::from(p == 3));
    job.run(&mut source(4), &mut Progress::new(false)).unwrap();
    let seen = image::open(folder.path().join("frame-0000/eye-0.png")).unwrap().to_rgb8();
    let blue = renderer::output::srgb_code((0.25 + 0.75 * 3.0) / 8.0);
    for (x, y) in [(0, 0), (17, 5), (39, 29)] {
        let expected = [
            renderer::output::srgb_code(x as f32 / 64.0),
            renderer::output::srgb_code(y as f32 / 64.0),
            blue,
        ];
        assert_eq!(seen.get_pixel(x, y).0, expected);
    }
}

#[test]
fn two_runs_write_the_same_bytes() {
    let read = || {
        let folder = tempfile::tempdir().unwrap();
        let job = job(folder.path(), 9, 1, |p| (p as f64 + 0.3) / 43.2);
        job.run(&mut source(9), &mut Progress::new(false)).unwrap();
        ["contact-sheet.png", "frame-0000/eye-0.exr"]
            .map(|name| std::fs::read(folder.path().join(name)).unwrap())
    };
    assert!(read() == read());
}

#[test]
fn a_failure_midway_leaves_whole_pictures_and_no_report() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(report::HTML), "of an earlier run").unwrap();
    let job = job(folder.path(), 4, 1, |_| 0.25);
    Job::prepare_output(folder.path()).unwrap();
    let mut source = Gradients { fails_before: Some(1), ..source(4) };
    let error = job.run(&mut source, &mut Progress::new(false)).unwrap_err().to_string();
    assert_eq!(error, "back-end 0 died");
    assert_eq!(files(folder.path()), ["frame-0000"]);
    let names = files(&folder.path().join("frame-0000"));
    assert_eq!(names, ["projector-02.exr", "projector-02.png", "projector-03.exr", "projector-03.png"]);
    for name in names.iter().filter(|name| name.ends_with("png")) {
        image::open(folder.path().join("frame-0000").join(name)).unwrap();
    }
}

#[test]
fn a_shorter_run_leaves_no_pictures_of_a_longer_one() {
    let folder = tempfile::tempdir().unwrap();
    job(folder.path(), 4, 3, |_| 0.25).run(&mut source(4), &mut Progress::new(false)).unwrap();
    assert_eq!(files(&folder.path().join("frame-0000")).len(), 1 + 2 * (4 + 1));
    let shorter = Job { exr: false, eyes: Vec::new(), ..job(folder.path(), 2, 1, |_| 0.5) };
    shorter.run(&mut source(2), &mut Progress::new(false)).unwrap();
    assert_eq!(files(folder.path()), ["contact-sheet.png", "frame-0000"]);
    assert_eq!(files(&folder.path().join("frame-0000")), ["projector-00.png", "projector-01.png"]);
}

/// All four billion of them at once would take all memory before the first is drawn.
#[test]
fn frames_are_made_one_after_another() {
    let folder = tempfile::tempdir().unwrap();
    let all = job(folder.path(), 4, u32::MAX, |_| 0.25);
    let mut source = Gradients { fails_before: Some(0), ..source(4) };
    let error = all.run(&mut source, &mut Progress::new(false)).unwrap_err().to_string();
    assert_eq!(error, "back-end 0 died");
}

#[test]
fn a_missing_picture_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let job = job(folder.path(), 4, 1, |_| 0.25);
    let mut source = Gradients { skips: Some(2), ..source(4) };
    let error = job.run(&mut source, &mut Progress::new(false)).unwrap_err().to_string();
    assert!(error.contains("[2]"), "{error}");
}

#[test]
fn a_folder_that_cannot_be_written_is_found_first() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    let error = Job::prepare_output(&folder.path().join("file/out")).unwrap_err().to_string();
    assert!(error.starts_with("cannot write "), "{error}");
}

#[test]
fn calibrated_codes_lie_beside_the_pictures_and_change_nothing_else() {
    let [plain, calibrated] = [false, true].map(|calibrated| {
        let folder = tempfile::tempdir().unwrap();
        let mut job = job(folder.path(), 4, 1, |_| 0.25);
        job.calibrated = calibrated;
        let finish = Finish { transfer: display_config::Transfer::Gamma(1.0), ..Finish::default() };
        job.display.projectors[2].finish = finish;
        job.run(&mut source(4), &mut Progress::new(false)).unwrap();
        let path = folder.path().join("frame-0000");
        let read = |name: String| (name.clone(), std::fs::read(path.join(name)).unwrap());
        files(&path).into_iter().map(read).collect::<BTreeMap<_, _>>()
    });
    let (codes, others): (Vec<_>, Vec<_>) =
        calibrated.into_iter().partition(|(name, _)| name.starts_with("calibrated-"));
    assert_eq!(others, plain.clone().into_iter().collect::<Vec<_>>());
    assert_eq!(codes.len(), 4);
    for (name, bytes) in codes {
        let as_drawn = &plain[&name.replace("calibrated", "projector")];
        assert_eq!(
            bytes == *as_drawn,
            name != "calibrated-02.png",
            "{name}: the third alone has another curve"
        );
    }
}
