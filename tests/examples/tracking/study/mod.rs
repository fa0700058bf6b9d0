//! How a tool's track does with simulated hands: tables in Markdown.

mod hand;
mod lag;
mod page;
mod random;
mod scene;
mod score;
mod sweep;
mod tracker;
mod viewer;

use hand::Motion;
use page::{Page, head, row, section};
use scene::Scene;
use score::{Score, Spread};
use tracking::TrackSettings;
use viewer::Method;

/// Samples a second.
const RATES_HZ: [f64; 2] = [60.0, 120.0];
/// From a sample to the frame that shows it.
const LATENCIES_MS: [u64; 3] = [0, 30, 60];
/// Shakes a second in the table of motions, and in that of shakes.
const SHAKE_HZ: f64 = 2.0;
const SHAKES_HZ: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 4.0, 6.0];
const METHODS: [(Method, &str); 4] = [
    (Method::Raw, "raw"),
    (Method::Filtered, "filtered"),
    (Method::Predicted, "predicted"),
    (Method::Track, "filtered and predicted"),
];

/// Writes all tables.
pub fn tables(page: &mut Page<'_>) {
    let about = "Jitter about its mean, RMS / 99 %: raw, filtered, and predicted 60 ms ahead without and with the filter.";
    section(page, "A still tool", about);
    stills(page, Unit::Millimetres);
    stills(page, Unit::Degrees);
    let about = "Error against where the tool is when the frame is seen, RMS / 99 %.";
    section(page, "A tool in motion", about);
    motions(page, Unit::Millimetres);
    motions(page, Unit::Degrees);
    lag::table(page);
    shakes(page);
    sweep::tables(page);
}

/// What is measured.
#[derive(Clone, Copy)]
enum Unit {
    Millimetres,
    Degrees,
}

impl Unit {
    fn name(self) -> &'static str {
        match self {
            Self::Millimetres => "mm",
            Self::Degrees => "°",
        }
    }

    fn of(self, score: &Score) -> Spread {
        match self {
            Self::Millimetres => score.distance_mm,
            Self::Degrees => score.angle_deg,
        }
    }
}

/// The head of a table with a column for each method.
fn methods(page: &mut Page<'_>, rows: &str, unit: Unit) {
    let columns = METHODS.map(|(_, name)| format!("{name}, {}", unit.name()));
    head(page, &[&[rows.to_owned()], &columns[..]].concat());
}

/// A row of it.
fn scores(page: &mut Page<'_>, name: &str, scene: &Scene, latency_ms: u64, unit: Unit) {
    let settings = TrackSettings::default();
    let cell = |(method, _)| unit.of(&scene.score(latency_ms, method, &settings)).to_string();
    row(page, name, &METHODS.map(cell));
}

fn stills(page: &mut Page<'_>, unit: Unit) {
    methods(page, "tool, samples a second", unit);
    for rate_hz in RATES_HZ {
        scores(page, &format!("in a stand, {rate_hz}"), &Scene::stand(rate_hz), 60, unit);
        scores(page, &format!("in a hand, {rate_hz}"), &Scene::new(Motion::Hold, rate_hz), 60, unit);
    }
}

fn motions(page: &mut Page<'_>, unit: Unit) {
    methods(page, "motion, latency, samples a second", unit);
    let motions =
        [("trace", Motion::Trace), ("reaches", Motion::Reach), ("reversals", Motion::Shake(SHAKE_HZ))];
    for (name, motion) in motions {
        for rate_hz in RATES_HZ {
            let scene = Scene::new(motion, rate_hz);
            for latency_ms in LATENCIES_MS {
                let name = format!("{name}, {latency_ms} ms, {rate_hz}");
                scores(page, &name, &scene, latency_ms, unit);
            }
        }
    }
}

/// Where prediction begins to hurt.
fn shakes(page: &mut Page<'_>) {
    let about = "A tool that is shaken by 5 cm to each side, 60 samples a second, seen 60 ms later.";
    section(page, "Reversals", about);
    methods(page, "shakes a second", Unit::Millimetres);
    for hz in SHAKES_HZ {
        let scene = Scene::new(Motion::Shake(hz), RATES_HZ[0]);
        scores(page, &hz.to_string(), &scene, 60, Unit::Millimetres);
    }
}
