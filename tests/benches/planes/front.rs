//! Error against time of both casters, from loose tolerances to tight ones.

use crate::measure::{COMPARED, Measured, codes, measure, renderer, truth};
use crate::scene::{Scene, wanted};
use frontend::report::plot::{Chart, Mark, Point, Series, Stroke};
use lightloom_tests::results::{self, Program, Results};
use optics::Quality;
use protocol::{CasterChoice, FrameState};
use std::path::Path;

/// Scenes of the plot.
const SCENES: [&str; 4] =
    ["head, semi-transparent", "head, opaque", "head, opaque, shaded", "cranium, shaded"];
/// Error allowed per step. The default is among them.
const TOLERANCES: [f64; 6] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5];
/// All views of the display, by whose seconds the casters are compared.
const VIEWS: f64 = 72.0;
/// The largest RMS error, of 255, at which single rays are asked how fast they are.
const ASKED_OF_RAYS: f64 = 0.3;

/// A way to cast a scene at several tolerances.
struct Way {
    name: &'static str,
    caster: CasterChoice,
    /// The longest step of a ray.
    step_voxels: f64,
}

const WAYS: [Way; 3] = [
    Way { name: "planes", caster: CasterChoice::Planes, step_voxels: 0.4 },
    Way { name: "rays", caster: CasterChoice::Rays, step_voxels: 0.4 },
    Way { name: "rays, steps of up to a voxel", caster: CasterChoice::Rays, step_voxels: 1.0 },
];

/// A tolerance, and what it led to: seconds for all views, and RMS error of 255.
#[derive(Clone, Copy)]
struct Place {
    tolerance: f64,
    seconds: f64,
    rms: f64,
}

pub fn run(folder: &Path) -> Result<(), String> {
    let mut results = Results::new(Program::Bench("planes"), "planes", "front");
    results.line("| scene | way | tolerance | seconds for 72 views | RMS, 99.9 %, largest error of 255 | rays as exact, times as long |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: |");
    let mut fastest = Vec::new();
    for scene in wanted(folder).into_iter().filter(|scene| SCENES.contains(&scene.name.as_str())) {
        let found = of_scene(&scene, &mut results);
        for (way, places) in WAYS.iter().zip(&found) {
            for (place, measured) in places {
                let ratio = match way.caster {
                    CasterChoice::Planes => seconds_of_rays(&found[1..], place.rms)
                        .map_or("–".to_owned(), |rays| format!("{:.1}", rays / place.seconds)),
                    _ => String::new(),
                };
                results.line(format!(
                    "| {} | {} | {:.0e} | {:.2} | {} | {ratio} |",
                    scene.name,
                    way.name,
                    place.tolerance,
                    place.seconds,
                    codes(&measured.errors),
                ));
            }
        }
        let within = found[1..].iter().flatten().map(|(place, _)| place).filter(|p| p.rms <= ASKED_OF_RAYS);
        fastest.extend(within.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).map(|place| {
            format!(
                "- Rays of {} take {:.1} s at RMS {:.3}, the fastest of those within {ASKED_OF_RAYS}.",
                scene.name, place.seconds, place.rms
            )
        }));
        write(&scene, &found)?;
    }
    results.line("");
    fastest.into_iter().for_each(|line| results.line(line));
    results.finish()
}

/// What a way made of a scene, tolerance by tolerance.
type Places = Vec<(Place, Measured)>;

/// What each way makes of a scene.
fn of_scene(scene: &Scene, results: &mut Results) -> Vec<Places> {
    let truth = truth(scene);
    let all: Vec<u32> = (0..VIEWS as u32).collect();
    let of_way = |way: &Way| {
        let projectors = if way.caster == CasterChoice::Planes { &all[..] } else { &COMPARED[..] };
        let (mut renderer, adapter) = renderer(scene, way.caster, projectors);
        results.drawn_by(&adapter);
        let at = |tolerance: f64| {
            let quality = Quality { tolerance, step_voxels: way.step_voxels, ..scene.frame.quality };
            let frame = FrameState { quality, ..scene.frame.clone() };
            let found = measure(&mut renderer, &frame, &truth);
            let seconds = found.seconds * VIEWS / projectors.len() as f64;
            let rms = found.errors.as_ref().map_or(f64::NAN, |errors| 255.0 * errors.rms);
            (Place { tolerance, seconds, rms }, found)
        };
        TOLERANCES.map(at).into_iter().collect()
    };
    WAYS.iter().map(of_way).collect()
}

/// Seconds that rays take at an RMS error: of the faster way, between two tolerances on a straight line of logarithms. None if
/// neither reaches it or both are more exact at all tolerances.
fn seconds_of_rays(ways: &[Places], rms: f64) -> Option<f64> {
    let of_way = |places: &Places| {
        places.windows(2).find_map(|ends| {
            let [(loose, _), (tight, _)] = ends else { return None };
            let share = (loose.rms.ln() - rms.ln()) / (loose.rms.ln() - tight.rms.ln());
            (0.0..=1.0)
                .contains(&share)
                .then(|| (loose.seconds.ln() * (1.0 - share) + tight.seconds.ln() * share).exp())
        })
    };
    ways.iter().filter_map(of_way).min_by(f64::total_cmp)
}

/// The plot of a scene, beside the page.
fn write(scene: &Scene, found: &[Places]) -> Result<(), String> {
    let Some(folder) = results::folder() else { return Ok(()) };
    let default = scene.frame.quality.tolerance;
    let point = |(place, _): &(Place, Measured)| Point {
        x: place.seconds,
        y: place.rms,
        title: format!("tolerance {:.0e}: {:.2} s, RMS {:.3}", place.tolerance, place.seconds, place.rms),
    };
    let line = |(number, (way, places)): (usize, (&Way, &Places))| {
        let line = Series::new(way.name, places.iter().map(point).collect());
        line.tone(number).mark(Mark::Dot).stroke(Stroke::Thin)
    };
    let mut series: Vec<Series> = WAYS.iter().zip(found).enumerate().map(line).collect();
    let at_default = found[..2].iter().flatten().filter(|(place, _)| place.tolerance == default);
    series.push(Series::new("the default", at_default.map(point).collect()).mark(Mark::Diamond));
    let chart = Chart {
        title: format!("{}: all 72 views of holo72, two cores", scene.name),
        x_label: "seconds".to_owned(),
        y_label: "RMS error of 255".to_owned(),
        series,
    };
    let name: String =
        scene.name.chars().filter(|c| *c != ',').map(|c| if c == ' ' { '-' } else { c }).collect();
    let path = folder.join(format!("planes-{name}.svg"));
    std::fs::write(&path, chart.svg()).map_err(|error| format!("{}: {error}", path.display()))
}
