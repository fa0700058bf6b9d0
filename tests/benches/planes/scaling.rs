//! How the time of row planes grows with views, voxels and threads.

use crate::measure::{measure, renderer};
use crate::scene::{self, Scene};
use display_config::{Display, Projector};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes;
use protocol::CasterChoice;

/// Numbers of views for which the volume of [`EDGE`] is drawn, besides all of the display.
const VIEWS: [usize; 3] = [1, 8, 288];
/// Voxels along the edges of volumes that are drawn for all views, besides [`EDGE`].
const EDGES: [u32; 5] = [128, 512, 1024, 2048, 4096];
const EDGE: u32 = 256;

pub fn run() -> Result<(), String> {
    let mut results = Results::new(Program::Bench("planes"), "planes", "scaling");
    results.line("| shells | views | threads | seconds | ms a view | Gsamples | bricks | RMS, 99.9 %, largest error of 255 |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    let threads = rayon::current_num_threads();
    for views in VIEWS {
        row(&mut results, &shells(with_views(scene::display(), views), EDGE), threads)?;
    }
    let scene = shells(scene::display(), EDGE);
    for threads in 1..=threads {
        row(&mut results, &scene, threads)?;
    }
    for edge in EDGES {
        row(&mut results, &shells(scene::display(), edge), threads)?;
    }
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

fn shells(display: Display, edge: u32) -> Scene {
    let shells = scenes::shells_of(&display, edge);
    Scene::new(format!("{edge}³"), display, shells.source, shells.frame)
}

fn row(results: &mut Results, scene: &Scene, threads: usize) -> Result<(), String> {
    let views = scene.display.projectors.len();
    let all: Vec<u32> = (0..views as u32).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| format!("{threads} threads: {error}"))?;
    let truth = if views == 72 { scene.truth() } else { &[] };
    let (found, adapter) = pool.install(|| {
        let (mut renderer, adapter) = renderer(scene, CasterChoice::Planes, &all);
        (measure(&mut renderer, &scene.frame, truth), adapter)
    });
    results.drawn_by(&adapter);
    results.line(format!(
        "| {} | {views} | {threads} | {:.2} | {:.1} | {:.3} | {} | {} |",
        scene.name,
        found.seconds,
        1e3 * found.seconds / views as f64,
        found.report.samples as f64 / 1e9,
        found.report.working_set_union,
        found.codes(),
    ));
    Ok(())
}
