//! What frame control costs besides rays: filling pictures with their ζ, and the look at the newest state.

use super::{PAGE, PROGRAM};
use display_config::Display;
use lightloom_tests::draw::{self, With};
use lightloom_tests::results::Results;
use lightloom_tests::scenes;
use protocol::{CasterChoice, DeviceChoice, FrameReport, FrameState, Pace, Refinement};
use renderer::refine::{Filled, Grain, Order, UNITS, change_at, fill, sparse};
use std::time::Instant;

const REPEATS: usize = 9;
/// The paper's screen, pixels.
const PAPER: [u32; 2] = [1440, 900];

/// The median of the milliseconds that something takes.
fn milliseconds(mut deed: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..REPEATS)
        .map(|_| {
            let began = Instant::now();
            deed();
            1e3 * began.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[REPEATS / 2]
}

pub fn measure() -> Result<(), String> {
    let mut results = Results::new(PROGRAM, PAGE, "costs");
    results.line(
        "A picture of 1440 × 900 pixels of which all has changed since the one before, one core, milliseconds, median of 9:",
    );
    results.line("");
    results.line("| units cast | filled anew, with ζ | going on from one unit less | τ of the first unit |");
    results.line("| ---: | ---: | ---: | ---: |");
    let order = Order::new(Grain::Pixels, PAPER);
    let pixel = |i: u32| [(f64::from(i) * 0.37).sin() as f32, 0.2, (f64::from(i) * 1e-4).cos() as f32, 1.0];
    let picture: Vec<f32> = (0..PAPER[0] * PAPER[1]).flat_map(pixel).collect();
    let darker = picture.iter().map(|n| 0.9 * n).collect();
    let before_picture = fill(darker, None, Filled::default(), &order, UNITS);
    let before = sparse(&picture, PAPER, order.first());
    let tau = milliseconds(|| {
        std::hint::black_box(change_at(&sparse(&picture, PAPER, order.first()), &before));
    });
    for done in [1, 4, 16, 32, 48, UNITS] {
        let time_from = |last: &Filled| {
            let mut copies = vec![(picture.clone(), last.clone()); REPEATS];
            milliseconds(|| {
                let (copy, last) = copies.pop().unwrap_or_default();
                std::hint::black_box(fill(copy, Some(&before_picture), last, &order, done));
            })
        };
        let anew = time_from(&Filled::default());
        let going_on = match done {
            1 => "–".to_owned(),
            _ => {
                let last = fill(picture.clone(), Some(&before_picture), Filled::default(), &order, done - 1);
                format!("{:.2}", time_from(&last))
            }
        };
        results.line(format!("| {done} | {anew:.2} | {going_on} | {tau:.2} |"));
    }
    results.line("");
    looks(&mut results)?;
    results.finish()
}

/// A tick of the renderer with a look at the newest state, and without.
fn looks(results: &mut Results) -> Result<(), String> {
    results.line(
        "Ticks of 4 units on all 8 pictures of `desk8` at its own size, CPU, milliseconds, median of 9:",
    );
    results.line("");
    results.line("| scene | what changes | a tick | with a look at the newest state | a complete picture |");
    results.line("| --- | --- | ---: | ---: | ---: |");
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    let everyone: Vec<u32> = (0..display.projectors.len() as u32).collect();
    let mut all = vec![scenes::shells(&display)];
    all.extend(scenes::cranium(&display));
    for scene in &all {
        let mut turned = scene.frame.clone();
        turned.display_from_volume = glam::DAffine3::from_rotation_y(0.02) * turned.display_from_volume;
        let mut denser = scene.frame.clone();
        denser.optics.extinction = scenes::scaled(&denser.optics.extinction, 1.05);
        for (what, newest) in [("it is turned", &turned), ("its extinction", &denser)] {
            let with = With { caster: CasterChoice::Rays, ..With::device(DeviceChoice::Cpu) };
            let mut renderer = draw::renderer(&display, &scene.source, &everyone, with).0;
            let full_ms = draw::draw_with(&mut renderer, &scene.frame).1.total_ms;
            let pace = Pace::Live { upload_bytes: 1 << 30, fade_s: 0.0 };
            let mut configuration = 0;
            let mut tick = |looks: bool| -> Result<f64, String> {
                let mut times = Vec::new();
                for _ in 0..REPEATS {
                    configuration += 1;
                    for to in [4, 8] {
                        let refinement = Some(Refinement { configuration, to });
                        let frame = FrameState { pace, refinement, ..scene.frame.clone() };
                        let newest = (looks && to == 8).then_some(newest);
                        let report = drawn(&mut renderer, &frame, newest)?;
                        times.extend((to == 8).then_some(report.total_ms));
                    }
                }
                times.sort_by(f64::total_cmp);
                Ok(times[REPEATS / 2])
            };
            let (alone, looking) = (tick(false)?, tick(true)?);
            results.line(format!("| {} | {what} | {alone:.1} | {looking:.1} | {full_ms:.0} |", scene.name));
        }
    }
    Ok(())
}

fn drawn(
    renderer: &mut renderer::Renderer,
    frame: &FrameState,
    newest: Option<&FrameState>,
) -> Result<FrameReport, String> {
    let failed = |error: renderer::RenderError| error.to_string();
    renderer.restart(frame).map_err(failed)?;
    newest
        .iter()
        .for_each(|newest| renderer.compare_with(&FrameState { pace: frame.pace, ..(*newest).clone() }));
    loop {
        let advance = renderer.advance(&|| false).map_err(failed)?;
        renderer.present(&mut drop).map_err(failed)?;
        if let Some(report) = advance.report {
            return Ok(*report);
        }
    }
}
