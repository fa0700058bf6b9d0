//! Rays in packets of eight against the same rays one by one.

use crate::measure::repeats;
use crate::scene::{COMPARED, Scene};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::twin_scene::{TwinScene, View, view};
use rayon::prelude::*;
use std::time::Instant;
use twin::{Cast, FeedbackCell, cast_pixels};

/// Pixels along the edge of what a thread casts at once, and of the blocks in it that go one after another, as in the renderer's tiles.
const TILE: u32 = 8;
const BLOCK: [u32; 2] = [4, 2];

pub fn run(scenes: &[Scene]) -> Result<(), String> {
    let mut results = Results::new(Program::Bench("planes"), "planes", "packets");
    results.line("| scene | Msamples | one by one, s | in packets, s | one by one takes times as long (of each round) | pixels that differ |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: |");
    // Calibrated projectors see the same.
    for scene in scenes.iter().filter(|scene| !scene.name.contains("calibrated")) {
        results.line(row(scene));
    }
    results.finish()
}

fn row(scene: &Scene) -> String {
    let Scene { display, frame, source, .. } = scene;
    let twin = TwinScene::new(display, frame, &**source).with_visible_cells();
    let views = COMPARED.map(|projector| view(display, projector, frame, &**source).rounded());
    let tiles = tiles(views[0].rays.raster);
    let cast_all = |at_once: usize| -> Vec<Cast<f32>> {
        views.iter().flat_map(|view| cast(&twin, view, &tiles, at_once)).collect()
    };
    let (mut times, mut ratios) = ([vec![], vec![]], vec![]);
    let mut casts = [vec![], vec![]];
    for _ in 0..repeats() {
        for (i, at_once) in [1, TILE as usize * TILE as usize].into_iter().enumerate() {
            let start = Instant::now();
            casts[i] = cast_all(at_once);
            times[i].push(start.elapsed().as_secs_f64());
        }
        ratios.push(times[0][times[0].len() - 1] / times[1][times[1].len() - 1]);
    }
    let samples: u64 = casts[0].iter().map(|cast| u64::from(cast.samples)).sum();
    let differ = casts[0].iter().zip(&casts[1]).filter(|(alone, packed)| alone != packed).count();
    let ratios: Vec<String> = ratios.iter().map(|ratio| format!("{ratio:.2}")).collect();
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[(times.len() - 1) / 2]
    };
    let [alone, packed] = times.each_mut().map(median);
    format!(
        "| {} | {:.0} | {alone:.2} | {packed:.2} | {} | {differ} |",
        scene.name,
        samples as f64 / 1e6,
        ratios.join(", "),
    )
}

/// The pixels of a raster, tile by tile.
fn tiles([width, height]: [u32; 2]) -> Vec<Vec<(u32, u32)>> {
    let corners = (0..height)
        .step_by(TILE as usize)
        .flat_map(|y| (0..width).step_by(TILE as usize).map(move |x| (x, y)));
    let tile = |(x0, y0): (u32, u32)| {
        let row = |y| (x0..(x0 + TILE).min(width)).map(move |x| (x, y));
        let mut pixels: Vec<(u32, u32)> = (y0..(y0 + TILE).min(height)).flat_map(row).collect();
        pixels.sort_by_key(|(x, y)| (y / BLOCK[1], x / BLOCK[0]));
        pixels
    };
    corners.map(tile).collect()
}

fn cast(twin: &TwinScene, view: &View<f32>, tiles: &[Vec<(u32, u32)>], at_once: usize) -> Vec<Cast<f32>> {
    let feedback: Vec<FeedbackCell> = twin.nodes.iter().map(|_| FeedbackCell::default()).collect();
    let casting = twin.casting(&view.scene, &feedback);
    let of_tile = |tile: &Vec<(u32, u32)>| -> Vec<Cast<f32>> {
        tile.chunks(at_once).flat_map(|pixels| cast_pixels(&casting, &view.rays, pixels)).collect()
    };
    tiles.par_iter().flat_map_iter(of_tile).collect()
}
