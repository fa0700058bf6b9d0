//! What an eye is shown of a moving scene when there is time for a quarter of the pixels of each frame: reconstructed
//! sub-frames, against full pictures at a quarter of the rate.
//!
//! `cargo run --release -p lightloom-tests --example reconstruction -- [--worst DIR]`. All contenders cast the same rays, and
//! whatever is shown is compared with the full picture of the instant at which it is shown: a picture that is late errs by
//! that. A sub-frame takes one frame's time, so it is shown one frame after the instant that it was cast for; a full picture
//! takes four, and is shown for four.

mod eyes;

use display_config::Display;
use glam::{DAffine3, DQuat, DVec3};
use lightloom_tests::compare::{Errors, errors_between};
use lightloom_tests::draw::{self, With};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, TestScene};
use optics::Optics;
use protocol::{DeviceChoice, FrameState, ProjectorImage, SubFrame};
use renderer::output::{PictureRef, write_png};
use renderer::present::{Classes, Raster, Thresholds, lattice_of, reconstruct};
use std::path::{Path, PathBuf};

const RATE_HZ: f64 = 60.0;
/// Half a second of motion, after as many frames of rest as fill every contender's memory.
const FRAMES: usize = 30;
const RESTING: usize = 8;
const PROJECTORS: [u32; 2] = [1, 5];
/// Pairs of thresholds, linear colour in units of 1/255.
const SWEEP: [(f32, f32); 7] =
    [(0.0, 1e-3), (1.0, 8.0), (4.0, 32.0), (8.0, 64.0), (16.0, 64.0), (32.0, 128.0), (1e3, 2e3)];

/// How a scene moves: a name, and the frame at so many seconds.
type Motion = (&'static str, fn(&FrameState, f64) -> FrameState);

const MOTIONS: [Motion; 4] = [
    ("turns by 15° a second", |frame, s| turned(frame, 15.0 * s)),
    ("turns by 90° a second", |frame, s| turned(frame, 90.0 * s)),
    ("moves by 10 cm a second", |frame, s| {
        let mut moved = frame.clone();
        moved.display_from_volume.translation += DVec3::new(0.1 * s, 0.0, 0.0);
        moved
    }),
    ("its extinction doubles in half a second", |frame, s| {
        let extinction = scenes::scaled(&frame.optics.extinction, 1.0 + 2.0 * s);
        FrameState { optics: Optics { extinction, ..frame.optics.clone() }, ..frame.clone() }
    }),
];

/// Turned about the point of the display's middle.
fn turned(frame: &FrameState, deg: f64) -> FrameState {
    let turn = DAffine3::from_quat(DQuat::from_rotation_y(deg.to_radians()));
    FrameState { display_from_volume: turn * frame.display_from_volume, ..frame.clone() }
}

/// The pictures of each instant.
type Shown = Vec<Vec<ProjectorImage>>;

/// The full pictures of each instant.
fn truths(display: &Display, scene: &TestScene, motion: &Motion, projectors: &[u32]) -> Shown {
    let mut renderer = draw::renderer(display, &scene.source, projectors, With::device(DeviceChoice::Cpu)).0;
    let instant = |i: usize| (i as f64 - RESTING as f64).max(0.0) / RATE_HZ;
    let frames = (0..RESTING + FRAMES).map(|i| (motion.1)(&scene.frame, instant(i)));
    frames.map(|frame| draw::draw_with(&mut renderer, &frame).0).collect()
}

/// What is shown at each instant, from the one on at which all contenders have something to show.
fn shown_of_sub_frames(truths: &Shown, thresholds: Thresholds, has_rows: bool) -> Shown {
    let mut shown = truths[0].clone();
    let mut all = vec![shown.clone()];
    let mut known = Classes::default();
    for (i, cast) in truths.iter().enumerate().take(truths.len() - 1) {
        // What rests is known once it has been cast, as a renderer knows it.
        let rests = i > 0 && truths[i - 1] == *cast;
        let lattice = lattice_of(Some(SubFrame::of_frame(i as u32)), has_rows);
        known = if rests { known } else { Classes::default() }.with(Classes::of_lattice(&lattice));
        for (shown, cast) in shown.iter_mut().zip(cast) {
            let raster = Raster { width: cast.width as usize, height: cast.height as usize };
            shown.rgba = reconstruct(&cast.rgba, Some(&shown.rgba), raster, known, thresholds);
        }
        all.push(shown.clone());
    }
    all
}

/// Full pictures that take `frames` frames each.
fn shown_of_full(truths: &Shown, frames: usize) -> Shown {
    (0..truths.len()).map(|i| truths[(i / frames * frames).saturating_sub(frames)].clone()).collect()
}

/// The errors over all instants of motion, and the worst instant.
fn judge(shown: &Shown, truths: &Shown) -> (Errors, usize) {
    let moving = RESTING..truths.len();
    let of = |range: std::ops::Range<usize>| {
        errors_between(&shown[range.clone()].concat(), &truths[range].concat())
    };
    let rms = |i: &usize| of(*i..*i + 1).rms;
    let worst = moving.clone().max_by(|a, b| rms(a).total_cmp(&rms(b))).unwrap_or(RESTING);
    (of(moving), worst)
}

fn write_worst(folder: &Path, name: &str, what: &str, image: &ProjectorImage) -> Result<(), String> {
    let file = format!("{}-{what}.png", name.replace([' ', ',', '°', '/'], "-"));
    let picture = PictureRef::of(image).map_err(|error| error.to_string())?;
    write_png(&folder.join(file), picture).map_err(|error| error.to_string())
}

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let worst: Option<PathBuf> = match arguments.next().as_deref() {
        None => None,
        Some("--worst") => Some(arguments.next().ok_or("--worst needs a folder")?.into()),
        Some(other) => return Err(format!("{other} is unknown; give nothing, or --worst DIR")),
    };
    let display = Display::load("desk8").map_err(|error| error.to_string())?.with_rasters(240, 180);
    let mut all = vec![scenes::shells(&display), scenes::stored_vessels(&display)];
    all.extend(scenes::cranium(&display));
    let moved: Vec<_> = all
        .iter()
        .flat_map(|scene| MOTIONS.iter().map(move |motion| (scene, motion)))
        .map(|(scene, motion)| {
            (format!("{}, {}", scene.name, motion.0), truths(&display, scene, motion, &PROJECTORS))
        })
        .collect();
    compare(&moved, worst.as_deref())?;
    eyes::compare(&display, &all, worst.as_deref())?;
    sweep(&moved)
}

fn compare(moved: &[(String, Shown)], worst: Option<&Path>) -> Result<(), String> {
    let mut results = Results::new(Program::Study("reconstruction"), "reconstruction", "comparison");
    results.line("| scene and motion | full pictures at 15 a second | quincunx at 60 | RMS ratio | rows at 30, full at 30 | rows |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: |");
    let told = |errors: &Errors| {
        format!("{:.2} / {:.1} / {:.0}", 255.0 * errors.rms, 255.0 * errors.p999, 255.0 * errors.max)
    };
    for (name, truths) in moved {
        let default = Thresholds::default();
        let (full, _) = judge(&shown_of_full(truths, 4), truths);
        let shown = shown_of_sub_frames(truths, default, false);
        let (quincunx, at) = judge(&shown, truths);
        // Row planes cast half of the pixels a frame: a full picture takes two.
        let (half, _) = judge(&shown_of_full(truths, 2), truths);
        let (rows, _) = judge(&shown_of_sub_frames(truths, default, true), truths);
        results.line(format!(
            "| {name} | {} | {} | {:.2} | {} | {} |",
            told(&full),
            told(&quincunx),
            full.rms / quincunx.rms,
            told(&half),
            told(&rows)
        ));
        if let Some(folder) = worst {
            std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
            write_worst(folder, name, "shown", &shown[at][0])?;
            write_worst(folder, name, "truth", &truths[at][0])?;
        }
    }
    results.finish()
}

fn sweep(moved: &[(String, Shown)]) -> Result<(), String> {
    let mut results = Results::new(Program::Study("reconstruction"), "reconstruction", "thresholds");
    let heads: String = SWEEP.iter().map(|(low, high)| format!(" {low} to {high} |")).collect();
    results.line(format!("| scene and motion |{heads}"));
    results.line(format!("| --- |{}", " ---: |".repeat(SWEEP.len())));
    let mut sums = [0.0; SWEEP.len()];
    for (name, truths) in moved {
        let rms = SWEEP.map(|(low, high)| {
            let thresholds = Thresholds { low: low / 255.0, high: high / 255.0 };
            255.0 * judge(&shown_of_sub_frames(truths, thresholds, false), truths).0.rms
        });
        sums.iter_mut().zip(rms).for_each(|(sum, rms)| *sum += rms.ln() / moved.len() as f64);
        let cells: String = rms.iter().map(|rms| format!(" {rms:.2} |")).collect();
        results.line(format!("| {name} |{cells}"));
    }
    let cells: String = sums.iter().map(|sum| format!(" {:.3} |", sum.exp())).collect();
    results.line(format!("| *geometric mean* |{cells}"));
    results.finish()
}
