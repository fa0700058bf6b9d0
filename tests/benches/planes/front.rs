//! Error against time of both casters, from loose tolerances to tight ones.

use crate::measure::{measure, renderer};
use crate::scene::{COMPARED, Scene};
use crate::sweep;
use frontend::report::plot::{Chart, Mark, Point, Series, Stroke};
use lightloom_tests::compare::{self, Errors};
use lightloom_tests::results::{self, Program, Results};
use optics::Quality;
use protocol::{CasterChoice, FrameState};

/// Scenes of the plot.
const SCENES: [&str; 4] =
    ["head, semi-transparent", "head, opaque", "head, opaque, shaded", "cranium, shaded"];
/// Error allowed per step. The default is among them.
const TOLERANCES: [f64; 6] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5];
/// All views of the display, by whose seconds the casters are compared.
const VIEWS: f64 = 72.0;
/// The largest RMS error, of 255, at which single rays are asked how fast they are.
const ASKED_OF_RAYS: f64 = 0.3;

/// How many planes the competitor has.
const COUNTS: [usize; 5] = [64, 128, 256, 512, 1024];

/// A way to draw a scene, more and more exactly.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Planes,
    /// With steps of up to so many voxels.
    Rays(f64),
    Sweep,
}

const WAYS: [Way; 4] = [Way::Planes, Way::Rays(0.4), Way::Rays(1.0), Way::Sweep];

impl Way {
    fn name(self) -> String {
        match self {
            Self::Planes => "planes".to_owned(),
            Self::Rays(1.0) => "rays, steps of up to a voxel".to_owned(),
            Self::Rays(_) => "rays".to_owned(),
            Self::Sweep => "plane sweep".to_owned(),
        }
    }
}

/// A setting of a way, and what it led to.
struct Place {
    setting: String,
    is_default: bool,
    /// For all views.
    seconds: f64,
    errors: Errors,
}

impl Place {
    /// Of 255.
    fn rms(&self) -> f64 {
        255.0 * self.errors.rms
    }
}

/// A way, and where each of its settings led to.
struct Line {
    way: Way,
    places: Vec<Place>,
}

impl Line {
    fn is_of_rays(&self) -> bool {
        matches!(self.way, Way::Rays(_))
    }
}

pub fn run(scenes: &[Scene]) -> Result<(), String> {
    let mut results = Results::new(Program::Bench("planes"), "planes", "front");
    results.line("| scene | way | tolerance, or planes | seconds for 72 views | RMS, 99.9 %, largest error of 255 | rays as exact, times as long |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: |");
    let mut fastest = Vec::new();
    for scene in scenes.iter().filter(|scene| SCENES.contains(&scene.name.as_str())) {
        let lines = WAYS.map(|way| Line { way, places: places(scene, way, &mut results) });
        let rays: Vec<&Line> = lines.iter().filter(|line| line.is_of_rays()).collect();
        for line in &lines {
            for place in &line.places {
                let ratio = match line.is_of_rays() {
                    true => String::new(),
                    false => seconds_of_rays(&rays, place.rms())
                        .map_or("–".to_owned(), |rays| format!("{:.1}", rays / place.seconds)),
                };
                results.line(format!(
                    "| {} | {} | {} | {:.2} | {} | {ratio} |",
                    scene.name,
                    line.way.name(),
                    place.setting,
                    place.seconds,
                    compare::codes(&place.errors),
                ));
            }
        }
        let within = rays.iter().flat_map(|line| &line.places).filter(|place| place.rms() <= ASKED_OF_RAYS);
        fastest.extend(within.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).map(|place| {
            format!(
                "- Rays of {} take {:.1} s at RMS {:.3}, the fastest of those within {ASKED_OF_RAYS}.",
                scene.name,
                place.seconds,
                place.rms()
            )
        }));
        write(scene, &lines)?;
    }
    results.line("");
    fastest.into_iter().for_each(|line| results.line(line));
    results.finish()
}

/// What a way makes of a scene.
fn places(scene: &Scene, way: Way, results: &mut Results) -> Vec<Place> {
    let all: Vec<u32> = (0..VIEWS as u32).collect();
    let own = scene.frame.quality;
    let (caster, projectors, step_voxels) = match way {
        Way::Planes => (CasterChoice::Planes, &all[..], own.step_voxels),
        Way::Rays(step_voxels) => (CasterChoice::Rays, &COMPARED[..], step_voxels),
        Way::Sweep => {
            let place = |count| {
                let swept = sweep::sweep(scene, count);
                let (setting, seconds) = (count.to_string(), swept.seconds);
                Place { setting, is_default: false, seconds, errors: swept.errors }
            };
            return COUNTS.map(place).into();
        }
    };
    let (mut renderer, adapter) = renderer(scene, caster, projectors);
    results.drawn_by(&adapter);
    let place = |tolerance: f64| {
        let quality = Quality { tolerance, step_voxels, ..own };
        let frame = FrameState { quality, ..scene.frame.clone() };
        let measured = measure(&mut renderer, &frame, scene.truth());
        Place {
            setting: format!("{tolerance:.0e}"),
            is_default: quality == own,
            seconds: measured.seconds * VIEWS / projectors.len() as f64,
            errors: measured.errors.expect("the views that are compared are among these"),
        }
    };
    TOLERANCES.map(place).into()
}

/// Seconds that rays take at an RMS error: of the faster way, between two tolerances on a straight line of logarithms. None if
/// neither reaches it or both are more exact at all tolerances.
fn seconds_of_rays(ways: &[&Line], rms: f64) -> Option<f64> {
    let of_way = |line: &&Line| {
        line.places.windows(2).find_map(|ends| {
            let [loose, tight] = ends else { return None };
            let share = (loose.rms() / rms).ln() / (loose.rms() / tight.rms()).ln();
            (0.0..=1.0)
                .contains(&share)
                .then(|| (loose.seconds.ln() * (1.0 - share) + tight.seconds.ln() * share).exp())
        })
    };
    ways.iter().filter_map(of_way).min_by(f64::total_cmp)
}

/// The plot of a scene, beside the page.
fn write(scene: &Scene, lines: &[Line]) -> Result<(), String> {
    let Some(folder) = results::folder() else { return Ok(()) };
    let point = |place: &Place| Point {
        x: place.seconds,
        y: place.rms(),
        title: format!("{}: {:.2} s, RMS {:.3}", place.setting, place.seconds, place.rms()),
    };
    let line = |(number, line): (usize, &Line)| {
        let series = Series::new(line.way.name(), line.places.iter().map(point).collect());
        series.tone(number).mark(Mark::Dot).stroke(Stroke::Thin)
    };
    let mut series: Vec<Series> = lines.iter().enumerate().map(line).collect();
    let at_default = lines.iter().flat_map(|line| &line.places).filter(|place| place.is_default);
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
