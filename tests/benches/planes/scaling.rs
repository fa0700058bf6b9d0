//! How the time of row planes grows with views, voxels and threads.

use crate::measure::{Measured, codes, measure, renderer, truth};
use crate::scene::{self, Scene};
use bricks::procedural::ProceduralVolume;
use display_config::{Display, Projector};
use glam::{DQuat, UVec3};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes;
use optics::Optics;
use protocol::{CasterChoice, FrameState};
use std::path::Path;
use std::sync::Arc;

const VIEWS: [usize; 4] = [1, 8, 72, 288];
const EDGES: [u32; 6] = [128, 256, 512, 1024, 2048, 4096];
/// Voxels along the edge of the volume that is drawn for several numbers of views.
const EDGE_OF_VIEWS: u32 = 256;

pub fn run(_: &Path) -> Result<(), String> {
    let mut results = Results::new(Program::Bench("planes"), "planes", "scaling");
    results.line("| shells | views | threads | seconds | ms a view | Gsamples | bricks | RMS, 99.9 %, largest error of 255 |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    let threads = rayon::current_num_threads();
    for views in VIEWS {
        let scene = shells(with_views(scene::display(), views), EDGE_OF_VIEWS);
        row(&mut results, &scene, EDGE_OF_VIEWS, threads)?;
    }
    for edge in EDGES {
        row(&mut results, &shells(scene::display(), edge), edge, threads)?;
    }
    row(&mut results, &shells(scene::display(), EDGE_OF_VIEWS), EDGE_OF_VIEWS, 1)?;
    results.finish()
}

/// A display of another number of projectors, evenly where its own are.
fn with_views(display: Display, views: usize) -> Display {
    let own = display.projectors.clone();
    let place = |view: usize| (view as f64 + 0.5) / views as f64 * own.len() as f64 - 0.5;
    let projector = |view: usize| {
        let at = place(view).clamp(0.0, own.len() as f64 - 1.0);
        let [a, b] = [at.floor(), at.ceil()].map(|i| own[i as usize].centre_in_display);
        let nearest = own[at.round() as usize].clone();
        Projector { name: format!("{view}"), centre_in_display: a.lerp(b, at.fract()), ..nearest }
    };
    Display { projectors: (0..views).map(projector).collect(), ..display }
}

/// The shells at so many voxels along an edge, as thick as at any other.
fn shells(display: Display, edge: u32) -> Scene {
    let of_tests = scenes::shells(&display);
    let source = ProceduralVolume::new("shells", UVec3::splat(edge), 1e-3).expect("the name is one of ours");
    let place = scenes::placed(&source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let own = of_tests.frame.optics;
    let per_voxel = 128.0 / f64::from(edge);
    let optics = Optics { extinction: scenes::scaled(&own.extinction, per_voxel), ..own };
    let frame = FrameState { optics, display_from_volume: place, ..of_tests.frame };
    Scene { name: format!("{edge}³"), display, source: Arc::new(source), frame }
}

fn row(results: &mut Results, scene: &Scene, edge: u32, threads: usize) -> Result<(), String> {
    let views = scene.display.projectors.len();
    let all: Vec<u32> = (0..views as u32).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| format!("{threads} threads: {error}"))?;
    let truth = if views == 72 { truth(scene) } else { Vec::new() };
    let (Measured { seconds, report, errors }, adapter) = pool.install(|| {
        let (mut renderer, adapter) = renderer(scene, CasterChoice::Planes, &all);
        (measure(&mut renderer, &scene.frame, &truth), adapter)
    });
    results.drawn_by(&adapter);
    results.line(format!(
        "| {edge}³ | {views} | {threads} | {seconds:.2} | {:.1} | {:.3} | {} | {} |",
        1e3 * seconds / views as f64,
        report.samples as f64 / 1e9,
        report.working_set_union,
        codes(&errors),
    ));
    Ok(())
}
