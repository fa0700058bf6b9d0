//! What blending over levels costs: samples and processor time per picture on the CPU device, with and without.
//!
//! `cargo run --release -p lightloom-tests --example blending`. Contenders take turns; times are medians.

use display_config::Display;
use lightloom_tests::blending_scenes::{self, is_split};
use lightloom_tests::presented::{Presented, picture};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::TestScene;
use lightloom_tests::twin_scene::{TwinScene, view};
use needs::Needs;
use optics::{Curve, Light};
use renderer::device::{CpuDevice, Device};
use std::sync::Arc;

const PROJECTOR: u32 = 5;
const ROUNDS: usize = 9;

/// Processor time of all threads that live; 0 where the system does not tell.
fn processor_ms() -> f64 {
    let Ok(threads) = std::fs::read_dir("/proc/self/task") else { return 0.0 };
    let told =
        threads.filter_map(|thread| std::fs::read_to_string(thread.ok()?.path().join("schedstat")).ok());
    told.filter_map(|text| text.split_whitespace().next()?.parse::<f64>().ok()).sum::<f64>() / 1e6
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Rows of a scene: each contender against the first.
fn compare(
    results: &mut Results,
    display: &Display,
    scene: &TestScene,
    contenders: &[(&str, TwinScene, Needs)],
) {
    let view = view(display, PROJECTOR, &scene.frame, &*scene.source).rounded();
    let rays = f64::from(view.rays.raster[0] * view.rays.raster[1]);
    let mut devices: Vec<Device> = contenders
        .iter()
        .map(|(_, twin, _)| {
            let mut device = Device::Cpu(Box::new(CpuDevice::new(twin.slots(), false)));
            twin.load(&mut device);
            device
        })
        .collect();
    let mut times = vec![Vec::new(); contenders.len()];
    let mut samples = vec![0; contenders.len()];
    for _ in 0..ROUNDS {
        for (i, ((_, _, needs), device)) in contenders.iter().zip(&mut devices).enumerate() {
            let before = processor_ms();
            samples[i] = picture(device, *needs, &view).1;
            times[i].push(processor_ms() - before);
        }
    }
    let ratios = |i: usize| times[i].iter().zip(&times[0]).map(|(a, b)| a / b).collect();
    for (i, (what, ..)) in contenders.iter().enumerate() {
        results.line(format!(
            "| {} | {what} | {:.1} | {:.1} | {:.3} |",
            scene.name,
            samples[i] as f64 / rays,
            median(times[i].clone()),
            median(ratios(i))
        ));
    }
}

fn main() -> Result<(), String> {
    let display = Display::load("desk8").expect("a preset");
    let display = display.with_rasters(240, 180);
    let mut results = Results::new(Program::Study("blending"), "blending", "blending");
    results.line("| scene | how | samples per ray | processor time, ms | ratio |");
    results.line("| --- | --- | ---: | ---: | ---: |");
    for (base, light) in
        [(blending_scenes::busy as fn(&Display) -> TestScene, true), (blending_scenes::half_hidden, false)]
    {
        for light in [None, light.then(Light::default)].into_iter().take(1 + usize::from(light)) {
            let mut scene = base(&display);
            scene.frame.light = light;
            let blended = blending_scenes::presented(&scene).scene(&display, &scene.frame);
            let blended = blended.with_visible_cells();
            let unblended = Presented::new(Arc::clone(&scene.source), is_split, |_| 1.0);
            let unblended = unblended.scene(&display, &scene.frame).with_visible_cells();
            let needs = blended.needs;
            let plain = Needs { blends: false, ..needs };
            // One material everywhere: the twin that looks for everything.
            let mut everything = unblended.clone();
            let optics = &mut scene.frame.optics.clone();
            optics.materials = Some(Curve::constant(light.unwrap_or_default().material()));
            let lit = Needs::of(optics, Some(&Light::default()), &scene.frame.quality);
            everything.tables = needs::tables::Tables::new(optics, &lit);
            let all = Needs { has_materials: true, ..plain };
            results.line(if light.is_some() { "| Phong |||||" } else { "| plain |||||" });
            compare(
                &mut results,
                &display,
                &scene,
                &[
                    ("no blending", unblended.clone(), plain),
                    ("blending, full weights", unblended.clone(), needs),
                    ("the twin of everything, no blending", everything, all),
                    ("blending", blended, needs),
                ],
            );
        }
    }
    results.finish()
}
