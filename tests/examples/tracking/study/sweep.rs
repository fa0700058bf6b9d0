//! Each setting of a track, varied about its default.

use super::hand::Motion;
use super::page::{Page, head, row, section};
use super::scene::Scene;
use super::viewer::Method;
use std::time::Duration;
use tracking::{OneEuro, TrackSettings};

const RATE_HZ: f64 = 60.0;
const LATENCY_MS: u64 = 60;
const SHAKE_HZ: f64 = 2.0;

/// A setting with its unit, its values, and how it is set.
type Setting = (&'static str, &'static [f64], fn(&mut TrackSettings, f64));

const SETTINGS: [Setting; 5] = [
    ("least cutoff, Hz", &[0.125, 0.25, 0.5, 1.0, 2.0], |settings, value| {
        both(settings, |filter| filter.least_cutoff_hz = value);
    }),
    ("cutoff per speed of positions, 1/m", &[0.0, 12.5, 25.0, 50.0, 100.0, 200.0], |settings, value| {
        settings.position.cutoff_per_speed = value;
    }),
    ("cutoff per speed of rotations, 1/rad", &[0.0, 2.0, 4.0, 8.0, 16.0, 32.0], |settings, value| {
        settings.rotation.cutoff_per_speed = value;
    }),
    ("cutoff of the velocity, Hz", &[0.25, 0.5, 1.0, 2.0, 4.0], |settings, value| {
        both(settings, |filter| filter.velocity_cutoff_hz = value);
    }),
    ("smoothing of the prediction, ms", &[4.0, 8.0, 12.0, 16.0, 24.0, 48.0], |settings, value| {
        settings.smoothing = Duration::from_secs_f64(1e-3 * value);
    }),
];

fn both(settings: &mut TrackSettings, set: impl Fn(&mut OneEuro)) {
    set(&mut settings.position);
    set(&mut settings.rotation);
}

/// A table for each setting: the others are at their defaults.
pub fn tables(page: &mut Page<'_>) {
    let scenes = [Motion::Hold, Motion::Trace, Motion::Reach, Motion::Shake(SHAKE_HZ)]
        .map(|motion| Scene::new(motion, RATE_HZ));
    let about = format!(
        "Jitter in a still hand and errors in motion, RMS, at {RATE_HZ} samples a second, seen {LATENCY_MS} ms later. \
         Defaults are bold."
    );
    section(page, "Settings", &about);
    for (name, values, set) in SETTINGS {
        head(page, &[name, "still", "trace", "reaches", "reversals"].map(str::to_owned));
        for &value in values {
            let mut settings = TrackSettings::default();
            set(&mut settings, value);
            let is_default = settings == TrackSettings::default();
            let name = if is_default { format!("**{value}**") } else { value.to_string() };
            row(page, &name, &scenes.each_ref().map(|scene| cell(scene, &settings)));
        }
    }
}

fn cell(scene: &Scene, settings: &TrackSettings) -> String {
    let score = scene.score(LATENCY_MS, Method::Track, settings);
    format!("{:.2} mm, {:.2}°", score.distance_mm.rms, score.angle_deg.rms)
}
