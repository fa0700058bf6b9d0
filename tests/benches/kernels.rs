//! What a kernel costs: features that a scene does not use, enhancers that do nothing, either filter, and compiling.
//!
//! `cargo bench -p lightloom-tests --bench kernels`; LIGHTLOOM_BENCH_PARTS=unused,enhancers,filter,compile takes the parts
//! named, LIGHTLOOM_BENCH_ROUNDS=n measures n times (9), LIGHTLOOM_BENCH_DEVICES=cpu,gpu on the devices named. Contenders
//! take turns within one process; the ratio is the median of the rounds' ratios, its spread the quartiles. Where the
//! processor draws, also as Mesa's software GPU, it is the process's processor time, which others on the machine disturb
//! less; elsewhere it is the wall-clock time of casting.

use bricks::BrickSource;
use bricks::store::CodeBits;
use display_config::Display;
use glam::DVec3;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::{compare, data, draw};
use optics::{
    BandPicker, ClipPlane, Curve, CurveValue, Detail, Enhancer, LayerOpacity, Light, Material, Mimda,
    MimdaForm, Probe, Quality, Ramp, Trapezoid,
};
use protocol::{DeviceChoice, FilterChoice, FrameState, ProjectorImage};
use renderer::Renderer;
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

/// One projector from the side and one near the middle.
const PROJECTORS: [u32; 2] = [1, 5];
/// Pixels of a projector.
const RASTER: [u32; 2] = [160, 120];
/// Pixels between those compared with the reference.
const STRIDE: u32 = 2;
/// Set in a process that only draws its first picture.
const FIRST_PICTURE: &str = "LIGHTLOOM_BENCH_FIRST_PICTURE";

/// One renderer and what it draws.
struct Contender {
    renderer: Renderer,
    frame: FrameState,
    adapter: String,
    is_on_processor: bool,
}

impl Contender {
    /// Draws once, so that bricks are loaded and kernels compiled.
    fn new(display: &Display, scene: &TestScene, frame: FrameState, with: draw::With) -> Self {
        let (renderer, info) = draw::renderer(display, &scene.source, &PROJECTORS, with);
        let is_on_processor = info.adapter.starts_with("cpu") || info.adapter.contains("llvmpipe");
        let mut contender = Self { renderer, frame, adapter: info.adapter, is_on_processor };
        contender.draw();
        contender
    }

    /// Milliseconds, and the pictures.
    fn draw(&mut self) -> (f64, Vec<ProjectorImage>) {
        let before = processor_ms();
        let (images, report) = draw::draw_with(&mut self.renderer, &self.frame);
        assert!(report.complete, "{}", report.shortfall);
        let spent = before.zip(processor_ms()).filter(|_| self.is_on_processor);
        (spent.map_or(report.stages.cast_ms, |(before, after)| after - before), images)
    }
}

/// Processor time of all threads that live; None where the system does not tell.
fn processor_ms() -> Option<f64> {
    let threads = std::fs::read_dir("/proc/self/task").ok()?;
    let nanoseconds = threads.map(|thread| {
        let told = std::fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        told.split_whitespace().next()?.parse::<f64>().ok()
    });
    Some(nanoseconds.sum::<Option<f64>>()? / 1e6)
}

/// The lower quartile, the median and the upper quartile.
fn quartiles(mut numbers: Vec<f64>) -> [f64; 3] {
    numbers.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| numbers[(numbers.len() - 1) * quarter / 4])
}

fn variable(name: &str, default: &str) -> String {
    std::env::var(name).unwrap_or_else(|_| default.into())
}

fn rounds() -> usize {
    variable("LIGHTLOOM_BENCH_ROUNDS", "9").parse().expect("the number of rounds is a whole number")
}

/// Lets two contenders take turns, and prints a row.
fn compare(results: &mut Results, what: &str, baseline: &mut Contender, other: &mut Contender) {
    results.drawn_by(&baseline.adapter);
    let (mut times, mut ratios) = ([vec![], vec![]], vec![]);
    for round in 0..rounds() {
        // Who is first changes, so that neither always finds the caches of the other.
        let [a, b] = if round % 2 == 0 {
            let a = baseline.draw().0;
            [a, other.draw().0]
        } else {
            let b = other.draw().0;
            [baseline.draw().0, b]
        };
        times[0].push(a);
        times[1].push(b);
        ratios.push(b / a);
    }
    let difference = compare::errors_between(&other.draw().1, &baseline.draw().1);
    let [a, b] = times.map(|times| quartiles(times)[1]);
    let [low, ratio, high] = quartiles(ratios);
    results.line(format!(
        "| {what} | {a:.1} | {b:.1} | {ratio:.3} ({low:.3} to {high:.3}) | {:.4} |",
        255.0 * difference.max
    ));
}

fn head(results: &mut Results, title: &str) {
    results.line(format!("\n{title}; median of {} rounds\n", rounds()));
    results.line("| what | without, ms | with, ms | ratio (quartiles) | largest difference of 255 |");
    results.line("| --- | ---: | ---: | ---: | ---: |");
}

/// The scenes, plain and lit.
fn all(display: &Display) -> Vec<TestScene> {
    let lit = [Some(scenes::shells(display)), scenes::cranium(display)];
    lit.into_iter().flatten().collect()
}

fn devices() -> Vec<DeviceChoice> {
    let wanted = variable("LIGHTLOOM_BENCH_DEVICES", "cpu,gpu");
    draw::devices().into_iter().filter(|d| wanted.contains(&format!("{d:?}").to_lowercase())).collect()
}

/// The kernel that is composed for what a scene uses, against the same picture by one that has all the rest, too: each
/// technique is on, at numbers that change nothing.
fn unused(results: &mut Results, display: &Display) {
    for device in devices() {
        head(
            results,
            &format!("A kernel of what a scene uses against one that leaves nothing out, {device:?}"),
        );
        let with = draw::With::device(device);
        for scene in all(display) {
            // Weights of blending levels would be looked at by both.
            let quality = Quality { blended: false, ..scene.frame.quality };
            let frame = FrameState { light: Some(Light::default()), quality, ..scene.frame.clone() };
            let mut lean = Contender::new(display, &scene, frame.clone(), with);
            let mut full = Contender::new(display, &scene, nothing_left_out(frame), with);
            compare(results, &format!("{}, lit", scene.name), &mut lean, &mut full);
            let mut frame = blended_mimda(scene.frame.clone());
            let mut lean = Contender::new(display, &scene, frame.clone(), with);
            // A light that leaves colours as they are.
            frame.light = Some(Light { ambient: 1.0, diffuse: 0.0, specular: 0.0, ..Light::default() });
            let mut full = Contender::new(display, &scene, nothing_left_out(frame), with);
            compare(results, &format!("{}, MImDA, levels blended", scene.name), &mut lean, &mut full);
        }
    }
}

/// A plain frame of blended levels, four times as coarse as usual, in which what is dense has importance.
fn blended_mimda(mut frame: FrameState) -> FrameState {
    let importance = Curve::new(vec![(0.3, 0.0), (0.8, 1.0)]).expect("two points that rise make a curve");
    frame.light = None;
    frame.optics.mimda = Some(Mimda { importance, gamma: 0.5, form: MimdaForm::Consistent });
    frame.quality = Quality { blended: true, lod_scale: 4.0, ..frame.quality };
    frame
}

/// A γ that is 0 in single precision, but not to those who ask whether it is.
const NO_GAMMA: f64 = 1e-60;

/// A lit frame with every technique that can be on and change nothing: importance, materials, detail and enhancers.
fn nothing_left_out(mut frame: FrameState) -> FrameState {
    let light = frame.light.unwrap_or_default();
    frame.light = Some(Light { detail: Detail::Unsharp { strength: 0.0 }, ..light });
    let Light { ambient, diffuse, specular, shininess, .. } = light;
    frame.optics.materials = Some(constant(Material { ambient, diffuse, specular, shininess }));
    let (gamma, form) = (NO_GAMMA, MimdaForm::Consistent);
    let idle = Mimda { importance: constant(0.0), gamma, form };
    frame.optics.mimda.get_or_insert(idle);
    frame.optics.enhancers = idle_enhancers().pop().map_or(Vec::new(), |(_, chain)| chain);
    frame
}

fn constant<T: CurveValue>(value: T) -> Curve<T> {
    Curve::new(vec![(0.0, value), (1.0, value)]).expect("two points that rise make a curve")
}

/// Enhancers of full strength that leave the picture of anything near the screen as it is.
fn idle_enhancers() -> Vec<(&'static str, Vec<Enhancer>)> {
    let facing = Ramp { low: 0.2, high: 0.8 };
    let everything = Trapezoid::new([0.0, 0.0, 1.0, 1.0]).expect("corners that do not fall make a band");
    let plane = Enhancer::ClipPlane(ClipPlane {
        point_in_display: DVec3::new(0.0, 0.0, -10.0),
        normal_in_display: DVec3::NEG_Z,
        context: facing,
        thickness_m: 0.0,
        boost: 1.0,
        strength: 1.0,
    });
    let probe = Enhancer::Probe(Probe {
        centre_in_display: DVec3::new(10.0, 10.0, 0.0),
        radius_m: 0.1,
        axis_in_display: DVec3::NEG_Z,
        facing,
        gradient_most: 0.1,
        edges: facing,
        strength: 1.0,
    });
    let picker = Enhancer::BandPicker(BandPicker {
        band: everything,
        axis_in_display: DVec3::NEG_Z,
        facing,
        strength: 1.0,
    });
    let layer = Enhancer::LayerOpacity(LayerOpacity {
        band: everything,
        axis_in_display: DVec3::NEG_Z,
        facing,
        away: 1.0,
        toward: 1.0,
    });
    vec![
        ("clip plane", vec![plane]),
        ("probe", vec![probe]),
        ("band picker", vec![picker]),
        ("layer opacity", vec![layer]),
        ("plane, probe and layer", vec![plane, probe, layer]),
    ]
}

/// Enhancers that the kernel cannot leave out: plane and probe reach a corner of the volume, the others all of it, where
/// they change next to nothing.
fn touching_enhancers(scene: &TestScene) -> Vec<(&'static str, Vec<Enhancer>)> {
    let all = scene.source.shape().dims().as_dvec3();
    let in_display = |share: f64| scene.frame.display_from_volume.transform_point3(all * share);
    let (corner, diagonal) = (in_display(1.0), in_display(1.0) - in_display(0.0));
    let everything = Trapezoid::new([0.0, 0.0, 1.0, 1.0]).expect("corners that do not fall make a band");
    let mut chains = idle_enhancers();
    for enhancer in chains.iter_mut().flat_map(|(_, chain)| chain) {
        match enhancer {
            Enhancer::ClipPlane(plane) => {
                plane.point_in_display = in_display(0.95);
                plane.normal_in_display = diagonal.normalize();
            }
            Enhancer::Probe(probe) => {
                (probe.centre_in_display, probe.radius_m) = (corner, 0.15 * diagonal.length());
            }
            Enhancer::BandPicker(picker) => picker.band = everything,
            Enhancer::LayerOpacity(layer) => (layer.away, layer.toward) = (1.0 + 1e-6, 1.0 + 1e-6),
        }
    }
    chains
}

fn enhancers(results: &mut Results, display: &Display) {
    type Chains = fn(&TestScene) -> Vec<(&'static str, Vec<Enhancer>)>;
    let kinds: [(&str, Chains); 2] =
        [("that change nothing", |_| idle_enhancers()), ("that touch the volume", touching_enhancers)];
    for (device, (kind, chains)) in devices().into_iter().flat_map(|d| kinds.map(|kind| (d, kind))) {
        head(results, &format!("Enhancers {kind}, {device:?}"));
        let with = draw::With::device(device);
        for scene in all(display) {
            for (kind, light) in [("plain", None), ("lit", Some(Light::default()))] {
                let frame = FrameState { light, ..scene.frame.clone() };
                let mut without = Contender::new(display, &scene, frame.clone(), with);
                for (name, chain) in chains(&scene) {
                    let mut frame = frame.clone();
                    frame.optics.enhancers = chain;
                    let mut enhanced = Contender::new(display, &scene, frame, with);
                    let what = format!("{}, {kind}: {name}", scene.name);
                    compare(results, &what, &mut without, &mut enhanced);
                }
            }
        }
    }
}

/// Eight fetches against the texture unit, with what each errs.
fn filters(results: &mut Results, display: &Display) {
    if !devices().contains(&DeviceChoice::Gpu) {
        return;
    }
    head(results, "The exact filter (with) against the texture unit's (without)");
    let Some(scene) = scenes::cranium(display) else { return };
    let mut errors = Vec::new();
    for bits in [CodeBits::Eight, CodeBits::Sixteen] {
        let source: Arc<dyn BrickSource> =
            Arc::new(data::cranium_of(bits).expect("the data was there for the scene"));
        for (kind, light) in [("plain", None), ("lit", Some(Light::default()))] {
            let frame = FrameState { light, ..scene.frame.clone() };
            let scene = TestScene { name: "cranium", source: Arc::clone(&source), frame };
            let truth = compare::truth(display, &scene.frame, &source, &PROJECTORS, STRIDE);
            let name = format!("cranium, {kind}, {} bits", bits.bits());
            let [mut hardware, mut exact] = [FilterChoice::Hardware, FilterChoice::Exact].map(|filter| {
                let with = draw::With { filter, ..draw::With::device(DeviceChoice::Gpu) };
                Contender::new(display, &scene, scene.frame.clone(), with)
            });
            compare(results, &name, &mut hardware, &mut exact);
            let error = |contender: &mut Contender| compare::errors(&contender.draw().1, &truth);
            errors.push(format!(
                "- {name}: texture unit {}; exact {}",
                error(&mut hardware),
                error(&mut exact)
            ));
        }
    }
    results.line(format!("\nAgainst the reference:\n\n{}", errors.join("\n")));
}

/// What the process of [`compiling`] does: opens the GPU, draws one picture of few pixels, and prints how long it took.
fn first_picture(display: &Display) {
    let display = display.with_rasters(8, 8);
    let scene = scenes::shells(&display);
    let started = Instant::now();
    draw::draw(
        &display,
        &scene.frame,
        &scene.source,
        &PROJECTORS[..1],
        draw::With::device(DeviceChoice::Gpu),
    );
    println!("{}", started.elapsed().as_secs_f64() * 1e3);
}

/// New processes until their first picture: without a cache, with an empty one, with one that has the kernel. The drivers'
/// own caches are switched off.
fn compiling(results: &mut Results) {
    if !devices().contains(&DeviceChoice::Gpu) {
        return;
    }
    let time = |folder: &std::path::Path, is_off: bool| {
        let mut command = Command::new(std::env::current_exe().expect("a process knows its program"));
        command.env(FIRST_PICTURE, "1").env("XDG_CACHE_HOME", folder);
        command.env("MESA_SHADER_CACHE_DISABLE", "true").env("__GL_SHADER_DISK_CACHE", "0");
        command.env("LIGHTLOOM_NO_CACHE", if is_off { "1" } else { "" });
        let output = command.output().expect("the bench runs itself");
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        printed.lines().last().and_then(|ms| ms.parse::<f64>().ok()).unwrap_or_else(|| panic!("{output:?}"))
    };
    let mut times = [vec![], vec![], vec![]];
    let mut kept = 0;
    for _ in 0..rounds() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        times[0].push(time(folder.path(), true));
        times[1].push(time(folder.path(), false));
        times[2].push(time(folder.path(), false));
        let pipelines = folder.path().join("lightloom/pipelines");
        let files = std::fs::read_dir(pipelines).into_iter().flatten().flatten();
        kept = files.filter_map(|file| file.metadata().ok()).map(|m| m.len()).sum();
    }
    results.line(format!(
        "A new process until its first picture of 8 × 8 pixels; median of {} rounds (quartiles)\n",
        rounds()
    ));
    for (what, times) in ["no cache", "an empty cache", "the cache of the run before"].iter().zip(times) {
        let [low, median, high] = quartiles(times);
        results.line(format!("- {what}: {median:.0} ms ({low:.0} to {high:.0})"));
    }
    results.line(format!("\nThe cache then holds {kept} bytes."));
}

fn main() -> Result<(), String> {
    let display = Display::load("desk8").expect("a preset");
    if std::env::var_os(FIRST_PICTURE).is_some() {
        first_picture(&display);
        return Ok(());
    }
    let display = display.with_rasters(RASTER[0], RASTER[1]);
    println!("{} × {} pixels of {} projectors of desk8", RASTER[0], RASTER[1], PROJECTORS.len());
    for part in variable("LIGHTLOOM_BENCH_PARTS", "unused,enhancers,filter,compile").split(',') {
        let results = |part| Results::new(Program::Bench("kernels"), "kernels", part);
        let mut results = match part {
            "unused" => results("unused"),
            "enhancers" => results("enhancers"),
            "filter" => results("filter"),
            "compile" => results("compile"),
            other => {
                return Err(format!("there is no part {other}: take unused, enhancers, filter or compile"));
            }
        };
        match part {
            "unused" => unused(&mut results, &display),
            "enhancers" => enhancers(&mut results, &display),
            "filter" => filters(&mut results, &display),
            _ => compiling(&mut results),
        }
        results.finish()?;
    }
    Ok(())
}
