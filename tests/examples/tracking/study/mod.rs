//! How a tool's track does with simulated hands: tables in Markdown.

mod hand;
mod lag;
mod random;
mod scene;
mod score;
mod sweep;
mod tracker;
mod viewer;

use hand::Motion;
use scene::Scene;
use score::Score;
use tracking::TrackSettings;
use viewer::Method;

/// Samples a second.
const RATES_HZ: [f64; 2] = [60.0, 120.0];
/// From a sample to the frame that shows it.
const LATENCIES_MS: [u64; 3] = [0, 30, 60];
/// Shakes a second in the table of motions, and in that of shakes.
const SHAKE_HZ: f64 = 2.0;
const SHAKES_HZ: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 4.0, 6.0];
const METHODS: [Method; 4] = [Method::Raw, Method::Filtered, Method::Predicted, Method::Track];

/// Writes all tables, line by line.
pub fn tables(line: &mut dyn FnMut(String)) {
    line("## A still tool".to_owned());
    line("Jitter about its mean, RMS / 99 %: raw, filtered, and predicted 60 ms ahead without and with the filter.".into());
    for unit in [Unit::Millimetres, Unit::Degrees] {
        head(
            line,
            &["tool, samples a second", "raw", "filtered", "predicted", "filtered and predicted"],
            unit,
        );
        for rate_hz in RATES_HZ {
            row(line, &format!("in a stand, {rate_hz}"), &Scene::stand(rate_hz), 60, unit);
            row(line, &format!("in a hand, {rate_hz}"), &Scene::new(Motion::Hold, rate_hz), 60, unit);
        }
    }
    line("\n## A tool in motion".to_owned());
    line("Error against where the tool is when the frame is seen, RMS / 99 %.".to_owned());
    for unit in [Unit::Millimetres, Unit::Degrees] {
        head(
            line,
            &["motion, latency, samples a second", "raw", "filtered", "predicted", "filtered and predicted"],
            unit,
        );
        motions(line, unit);
    }
    lag::table(line);
    shakes(line);
    sweep::tables(line);
}

/// What is measured.
#[derive(Clone, Copy)]
enum Unit {
    Millimetres,
    Degrees,
}

impl Unit {
    fn of(self, score: &Score) -> score::Spread {
        match self {
            Self::Millimetres => score.distance_mm,
            Self::Degrees => score.angle_deg,
        }
    }
}

/// The head of a table whose numbers are of a unit.
fn head(line: &mut dyn FnMut(String), names: &[&str], unit: Unit) {
    let unit = match unit {
        Unit::Millimetres => "mm",
        Unit::Degrees => "°",
    };
    let units: String = names[1..].iter().map(|name| format!(" {name}, {unit} |")).collect();
    line(format!("\n| {} |{units}", names[0]));
    line(format!("| --- |{}", " ---: |".repeat(names.len() - 1)));
}

/// A row with each method.
fn row(line: &mut dyn FnMut(String), name: &str, scene: &Scene, latency_ms: u64, unit: Unit) {
    let settings = TrackSettings::default();
    let cell = |method| format!(" {} |", unit.of(&scene.score(latency_ms, method, &settings)));
    line(format!("| {name} |{}", METHODS.map(cell).concat()));
}

fn motions(line: &mut dyn FnMut(String), unit: Unit) {
    let motions =
        [("trace", Motion::Trace), ("reaches", Motion::Reach), ("reversals", Motion::Shake(SHAKE_HZ))];
    for (name, motion) in motions {
        for rate_hz in RATES_HZ {
            let scene = Scene::new(motion, rate_hz);
            for latency_ms in LATENCIES_MS {
                row(line, &format!("{name}, {latency_ms} ms, {rate_hz}"), &scene, latency_ms, unit);
            }
        }
    }
}

/// Where prediction begins to hurt.
fn shakes(line: &mut dyn FnMut(String)) {
    line("\n## Reversals".to_owned());
    line("A tool that is shaken by 5 cm to each side, 60 samples a second, seen 60 ms later.".to_owned());
    let names = ["shakes a second", "raw", "filtered", "predicted", "filtered and predicted"];
    head(line, &names, Unit::Millimetres);
    for hz in SHAKES_HZ {
        let scene = Scene::new(Motion::Shake(hz), RATES_HZ[0]);
        row(line, &hz.to_string(), &scene, 60, Unit::Millimetres);
    }
}
