//! How smoothly pictures follow each other while detail comes and goes: tables in Markdown, and difference pictures.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example continuity -- [-o DIR] [--fade S] [--blended true|false]
//!     [--frames N] [--raster WxH] [--volume shells|octaves] [--edge N] [--upload-mib N] [--gpu] [--fades S,S,...]
//! ```
//!
//! One projector of holo72 with a reduced raster, and a volume that doubles in size in one second: nested shells, whose pixels
//! on one surface are told from those where a rim passes, or dense waves of all octaves, of which all pixels count. Complete frames tell
//! what motion alone changes, and what pops when the rule of detail changes its mind; live ones what loading adds: with
//! blending (`--fade`, half a second without it) and without it. `--blended` picks one of the two. A motion begins when the
//! detail of its first frame is at rest; with the object still, the sequence begins with the coarsest brick alone, and all
//! that changes is detail that comes; borders are not looked for there, see [`lightloom_tests::borders`]. The canary is a
//! sequence with seams and a jump of detail: both measures have to find them. Compare RMS with RMS: at steep rims the
//! largest numbers are the surface's own bends. `--fades` draws cold starts alone, one for each fade, until they are at
//! rest.

mod arguments;

use arguments::{Arguments, arguments};
use bricks::BrickSource;
use bricks::procedural::{ProceduralVolume, field_named};
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use lightloom_tests::borders::{BorderSteps, Shown, border_steps, is_one_surface, shown};
use lightloom_tests::cold_start::cold_start;
use lightloom_tests::draw::{self, With};
use lightloom_tests::motion::{
    Approach, Continuity, FRAMES_PER_SECOND, Spread, borrowed, continuity, difference, draw_sequence,
    standing_still, steps,
};
use lightloom_tests::octaves::{Octaves, cloudy};
use lightloom_tests::remembered::Remembered;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self};
use optics::{Light, Optics};
use protocol::{DeviceChoice, FrameState, Pace, ProjectorImage};
use renderer::Renderer;
use renderer::output::write_png;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Near the middle.
const PROJECTOR: u32 = 36;
/// Every so many frames, borders are looked for.
const BORDERS_EVERY: usize = 10;
/// Frames until a sequence must have started.
const MOST_WARMING: u32 = 3000;
/// Frames of a cold start at most.
const MOST_COLD: u32 = 6000;
/// Difference pictures are so much brighter.
const GAIN: f32 = 8.0;

/// What all sequences show.
struct Stage {
    display: Display,
    source: Arc<dyn BrickSource>,
    has_shells: bool,
    device: DeviceChoice,
    out: Option<PathBuf>,
}

/// What each pixel of a frame shows.
type Surface = Arc<[Option<Shown>]>;

/// How a sequence gets its detail.
#[derive(Clone, Copy)]
struct Manner {
    name: &'static str,
    pace: Pace,
    blended: bool,
}

impl Manner {
    fn of(&self, frames: &[FrameState]) -> Vec<FrameState> {
        let mut frames = frames.to_vec();
        for frame in &mut frames {
            (frame.pace, frame.quality.blended) = (self.pace, self.blended);
        }
        frames
    }
}

/// What came of a sequence.
struct Outcome {
    images: Vec<ProjectorImage>,
    bricks_loaded: u64,
    /// Frames that were drawn live, as the device's account tells.
    live: usize,
    seconds: f64,
}

/// When live frames begin to count.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    /// When all detail of the first of them is there.
    AtRest,
    /// When its coarsest brick is.
    AtRoot,
}

/// Draws the first frame of a live sequence again and again until it may start; yields the sequence, which goes on from
/// there in time.
fn warm_up(renderer: &mut Renderer, frames: &[FrameState], start: Start) -> Vec<FrameState> {
    let later = |frame: &FrameState, by_s: f64| FrameState { time_s: frame.time_s + by_s, ..frame.clone() };
    for number in 0..MOST_WARMING {
        let by_s = f64::from(number) / FRAMES_PER_SECOND;
        let (_, report) = draw::draw_with(renderer, &later(&frames[0], by_s));
        let is_ready = match start {
            Start::AtRest => report.complete,
            Start::AtRoot => report.bricks_resident > 0,
        };
        if is_ready {
            return frames.iter().map(|frame| later(frame, by_s + 1.0 / FRAMES_PER_SECOND)).collect();
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    panic!("not ready after {MOST_WARMING} frames");
}

/// With an empty cache.
fn renderer(stage: &Stage) -> Renderer {
    let with = With { cache_bytes: 2 << 30, ..With::device(stage.device) };
    draw::renderer(&stage.display, &stage.source, &[PROJECTOR], with).0
}

/// Draws a sequence from an empty cache.
fn play(stage: &Stage, frames: &[FrameState], start: Start) -> Outcome {
    let started = Instant::now();
    let mut renderer = renderer(stage);
    let is_live = matches!(frames[0].pace, Pace::Live { .. });
    let warm = if is_live { warm_up(&mut renderer, frames, start) } else { frames.to_vec() };
    let frames = warm.as_slice();
    let mut outcome = Outcome { images: Vec::new(), bricks_loaded: 0, live: 0, seconds: 0.0 };
    draw_sequence(&mut renderer, frames, |_, report, images| {
        outcome.images.extend(images);
        outcome.bricks_loaded += report.bricks_loaded;
        outcome.live += usize::from(report.upkeep.is_some());
    });
    outcome.seconds = started.elapsed().as_secs_f64();
    outcome
}

/// What the pixels of each frame show; nothing where the volume has no surfaces.
fn surfaces(stage: &Stage, frames: &[FrameState]) -> Vec<Surface> {
    if !stage.has_shells {
        return Vec::new();
    }
    let dims = stage.source.shape().dims().as_dvec3();
    let field = field_named("shells", dims / dims.max_element()).expect("the name is one of ours");
    let mut found: Vec<Surface> = Vec::new();
    for (number, frame) in frames.iter().enumerate() {
        let same = number > 0 && frames[number - 1].display_from_volume == frame.display_from_volume;
        let before = found.last().filter(|_| same).cloned();
        let surface = || shown(&stage.display, PROJECTOR, frame, &*field, &stage.source.shape()).into();
        found.push(before.unwrap_or_else(surface));
    }
    found
}

/// The worst of every tenth picture.
fn worst_borders(surfaces: &[Surface], images: &[ProjectorImage], pixel_m: f64) -> Option<BorderSteps> {
    let pairs = surfaces.iter().zip(images).step_by(BORDERS_EVERY);
    let measured = pairs.map(|(surface, image)| border_steps(image, surface, pixel_m));
    measured.reduce(|a, b| BorderSteps {
        inside: a.inside.max(b.inside),
        same_level: a.same_level.max(b.same_level),
        levels: a.levels.max(b.levels),
        pairs: std::array::from_fn(|kind| a.pairs[kind] + b.pairs[kind]),
    })
}

/// Whether a pixel stays on one piece of surface over four frames; always true where there are no surfaces.
fn stays(surfaces: &[Surface], first: usize, pixel: usize, pixel_m: f64) -> bool {
    if surfaces.is_empty() {
        return true;
    }
    let shown: Option<Vec<Shown>> = surfaces[first..first + 4].iter().map(|surface| surface[pixel]).collect();
    shown.is_some_and(|shown| is_one_surface(&shown, pixel_m))
}

/// Writes the last picture, and what changed in the one with the largest pop.
fn write_pictures(folder: &Path, name: &str, images: &[ProjectorImage], at: usize) -> Result<(), String> {
    let file =
        |what: &str| folder.join(format!("{}-{what}.png", name.replace([' ', ','], "-").replace("--", "-")));
    let text = |error: renderer::output::OutputError| error.to_string();
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    if let Some(last) = images.last() {
        write_png(&file("last"), borrowed(last)).map_err(text)?;
    }
    if at > 0 {
        let change = difference(&images[at - 1], &images[at], GAIN);
        write_png(&file("pop"), change.view().map_err(text)?).map_err(text)?;
    }
    Ok(())
}

fn row(
    results: &mut Results,
    name: &str,
    whole: Continuity,
    surface: Continuity,
    borders: Option<BorderSteps>,
    last: Spread,
    outcome: &Outcome,
) {
    let of = |steps: fn(&BorderSteps) -> Spread, kind: usize| {
        borders.map_or_else(|| "-".to_owned(), |b| format!("{} ({})", steps(&b), b.pairs[kind]))
    };
    results.line(format!(
        "| {name} | {} | {} | {} | {} | {} | {} | {} | {last} | {} | {} | {:.1} |",
        whole.step,
        surface.step,
        surface.pop,
        surface.pops_at,
        of(|b| b.inside, 0),
        of(|b| b.same_level, 1),
        of(|b| b.levels, 2),
        outcome.bricks_loaded,
        outcome.live,
        outcome.seconds
    ));
}

/// What both measures must find: pictures whose leaves of even depth are too coarse by three levels, and from the middle
/// of the sequence on those of odd depth instead; without surfaces, all of them from there on.
fn spoiled(stage: &Stage, frames: &[FrameState], surfaces: &[Surface], fine: &[ProjectorImage]) -> Outcome {
    let mut coarse = frames.to_vec();
    for frame in &mut coarse {
        frame.quality.lod_scale *= 8.0;
    }
    let mut outcome = play(stage, &coarse, Start::AtRest);
    let middle = fine.len() / 2;
    if surfaces.is_empty() {
        outcome.images[..middle].clone_from_slice(&fine[..middle]);
    }
    for (number, (image, surface)) in outcome.images.iter_mut().zip(surfaces).enumerate() {
        let is_coarse = |leaf: &Shown| leaf.leaf.depth.is_multiple_of(2) == (number < middle);
        let kept = surface.iter().map(|shown| shown.as_ref().is_some_and(is_coarse));
        let pixels = image.rgba.chunks_exact_mut(4).zip(fine[number].rgba.chunks_exact(4));
        for ((pixel, fine), _) in pixels.zip(kept).filter(|(_, kept)| !kept) {
            pixel.copy_from_slice(fine);
        }
    }
    outcome
}

fn measure(
    results: &mut Results,
    stage: &Stage,
    (motion, start): (&str, Start),
    frames: &[FrameState],
    manners: &[Manner],
) -> Result<(), String> {
    let surfaces = surfaces(stage, frames);
    let raster = &stage.display.projectors[PROJECTOR as usize].raster;
    let pixel_m = stage.display.width_m / f64::from(raster.width);
    let mut truth: Option<Vec<ProjectorImage>> = None;
    let mut tell = |name: &str, outcome: &Outcome| {
        let truth = truth.get_or_insert_with(|| outcome.images.clone());
        let whole = continuity(&outcome.images, |_, _| true);
        let found = continuity(&outcome.images, |first, pixel| stays(&surfaces, first, pixel, pixel_m));
        let is_fine = start == Start::AtRest || outcome.live == 0;
        let borders = is_fine.then(|| worst_borders(&surfaces, &outcome.images, pixel_m)).flatten();
        let name = format!("{motion}, {name}");
        let ends = outcome.images.last().zip(truth.last());
        let last = ends.map_or_else(Vec::new, |(image, truth)| steps(image, truth));
        row(results, &name, whole, found, borders, Spread::of(last), outcome);
        match &stage.out {
            Some(folder) => write_pictures(folder, &name, &outcome.images, found.pops_at),
            None => Ok(()),
        }
    };
    let complete = play(stage, frames, start);
    tell("complete", &complete)?;
    tell("canary", &spoiled(stage, frames, &surfaces, &complete.images))?;
    for manner in manners {
        let outcome = play(stage, &manner.of(frames), start);
        tell(manner.name, &outcome)?;
        if outcome.live == 0 {
            eprintln!("{motion}, {}: this renderer drew every frame complete", manner.name);
        }
    }
    Ok(())
}

/// Cold starts of a view, one for each fade.
fn cold_starts(stage: &Stage, frame: &FrameState, fades_s: &[f64], upload_bytes: u64) -> Result<(), String> {
    let mut results = Results::new(Program::Study("continuity"), "continuity", "fades");
    results.line("| fade, s | step of any pixel | step on surfaces | at rest after, s | frames |");
    results.line("| ---: | ---: | ---: | ---: | ---: |");
    let surface = &surfaces(stage, std::slice::from_ref(frame))[0];
    for &fade_s in fades_s {
        let mut live = FrameState { pace: Pace::Live { upload_bytes, fade_s }, ..frame.clone() };
        live.quality.blended = true;
        let found = cold_start(&mut renderer(stage), &live, MOST_COLD, |pixel| surface[pixel].is_some());
        let rest = found.rest_s.map_or_else(|| "-".to_owned(), |rest_s| format!("{rest_s:.2}"));
        let (step, on_surfaces, frames) = (found.step, found.step_on_surfaces, found.frames);
        results.line(format!("| {fade_s} | {step} | {on_surfaces} | {rest} | {frames} |"));
    }
    results.finish()
}

/// Shells of one colour: what changes in a picture is where they are and how they end, not what they wear.
fn plain(edge: u32) -> Optics {
    let most = 0.5 * 4096.0 / f64::from(edge);
    scenes::optics(
        (0.0, 1.0),
        &vec![(0.03, 0.0), (0.1, most), (1.0, most)],
        &vec![(0.0, [0.9, 0.35, 0.1]), (0.4, [0.1, 0.6, 0.9]), (1.0, [1.0, 1.0, 0.9])],
    )
}

fn main() -> Result<(), String> {
    let Arguments { out, fade_s, fades_s, blended, frames, raster, has_shells, edge, upload_mib, device } =
        arguments()?;
    let display = Display::load("holo72").map_err(|error| error.to_string())?;
    let display = display.with_rasters(raster.0, raster.1);
    let volume: Arc<dyn BrickSource> = if has_shells {
        let volume = ProceduralVolume::new("shells", UVec3::splat(edge), 1e-3);
        Arc::new(volume.map_err(|error| error.to_string())?)
    } else {
        Arc::new(Octaves::new(edge, 1))
    };
    let source: Arc<dyn BrickSource> = Arc::new(Remembered::new(volume));
    let approach = Approach {
        from_m: 0.5 * display.height_m,
        to_m: display.height_m,
        rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), 0.5),
        frames,
    };
    let stage = Stage { display, source, has_shells, device, out };
    // Gradients are per voxel, and voxels are small here: surfaces are to be shaded all the same.
    let light =
        Light { gradient_half: 0.2 / f64::from(edge), ambient: 0.1, diffuse: 0.9, ..Light::default() };
    let optics = if has_shells { plain(edge) } else { cloudy(edge) };
    let moving = approach.frames(&stage.display, &*stage.source, &optics, light);
    let live = |fade_s| Pace::Live { upload_bytes: upload_mib << 20, fade_s };
    let blends = Manner { name: "live, blended", pace: live(fade_s), blended: true };
    let jumps = Manner { name: "live, not blended", pace: live(0.0), blended: false };
    let is_asked_for = |manner: &Manner| blended.is_none_or(|b| b == manner.blended);
    let manners: Vec<Manner> = [blends, jumps].into_iter().filter(is_asked_for).collect();
    if !fades_s.is_empty() {
        return cold_starts(&stage, &moving[0], &fades_s, upload_mib << 20);
    }
    let part = if has_shells { "sequences" } else { "dense" };
    let name = if has_shells { "Shells" } else { "Waves of all octaves" };
    let mut results = Results::new(Program::Study("continuity"), "continuity", part);
    results.line(format!(
        "{name}, {edge}³, doubling in {frames} frames; {} × {} pixels. Units of 1/255: RMS / 99.9 % / largest of the worst frame.\n",
        raster.0, raster.1
    ));
    results.line(
        "| sequence | step of any pixel | step on surfaces | pop on surfaces | at frame | excess inside leaves (pairs) | across leaves of a level | across levels | last frame against complete | bricks loaded | live frames | seconds |",
    );
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    measure(&mut results, &stage, ("moving", Start::AtRest), &moving, &manners)?;
    measure(&mut results, &stage, ("still", Start::AtRoot), &standing_still(&moving), &manners)?;
    results.finish()
}
