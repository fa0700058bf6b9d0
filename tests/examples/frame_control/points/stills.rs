//! Still pictures by each way, with few rays and with many.

use super::kernels::Kernels;
use super::patterns::Patterns;
use super::plan::{Plan, SHARES, Way};
use super::shots::{Erred, Shots, Truth};
use super::strip;
use crate::{PAGE, PROGRAM, RASTER};
use display_config::Display;
use lightloom_tests::points::Pattern;
use lightloom_tests::results::Results;

/// The larger raster: the paper's 16,384 sites are for about as many pixels.
const LARGE: [u32; 2] = [640, 480];
const WAYS: [(&str, Way); 4] = [
    ("lattices, filled in space", Way::Filled),
    ("points, level after level", Way::Levels),
    ("points, at once", Way::AtOnce),
    ("jittered, at once", Way::Jittered),
];
/// Kernels are sought for the even patterns at these depths, and for the finest level.
const EVEN_DEPTHS: [(usize, u32); 5] = [(0, 0), (0, 1), (0, 2), (1, 3), (0, 3)];

/// What the ways err with a share of the rays in one still; None of those that have nothing to show.
type Row = [Option<(Erred, f64)>; WAYS.len()];

/// A still by all ways.
struct Judged {
    volume: &'static str,
    /// A row for each share.
    rows: Vec<Row>,
    /// All tiles of the points against both truths, and our complete picture against means.
    finished: [Erred; 2],
    complete: Erred,
}

pub fn compare() -> Result<(), String> {
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    let mut results = Results::new(PROGRAM, PAGE, "points");
    let patterns = Patterns::new(&mut results)?;
    raster(&mut results, &display, &patterns, RASTER, (&patterns.small, 4), 0)?;
    raster(&mut results, &display, &patterns, LARGE, (&patterns.full, 3), 2)?;
    results.finish()
}

/// All of a raster, for which the even patterns have to be so much deeper.
fn raster(
    results: &mut Results,
    display: &Display,
    patterns: &Patterns,
    size: [u32; 2],
    (pattern, depth): (&Pattern, u32),
    deeper: u32,
) -> Result<(), String> {
    let shots = Shots::of_all(display, size, if size == RASTER { 3 } else { 1 })?;
    let stills: usize = shots.iter().map(Shots::count).sum();
    let apart = shots.iter().map(Shots::apart).fold(0.0, f32::max);
    results.line(format!(
        "**{} × {} pixels**, {stills} stills; levels of {} sites. Drawn on the raster itself, no colour is farther than {:.3} / 255 from the same ray of the finer one. The best Gaussians:",
        size[0], size[1], pattern.places().len(), 255.0 * apart,
    ));
    results.line("");
    let even = EVEN_DEPTHS.map(|(which, depth)| (&patterns.even[which], depth + deeper));
    let levels: Vec<(&Pattern, u32)> = even.into_iter().chain([(pattern, depth)]).collect();
    let kernels = Kernels::best(results, &shots, size, &levels);
    let grid = [0, 1, 2, 3].map(|depth| (&patterns.jittered, depth + deeper));
    results.line("And of the grid's cells:");
    results.line("");
    let jittered = Kernels::best(results, &shots, size, &grid);
    let plan = Plan::new(size, (pattern, depth), deeper, patterns, [&kernels, &jittered]);
    let all = shots.iter().flat_map(|shots| (0..shots.count()).map(move |instant| (shots, instant)));
    let judged: Vec<Judged> = all.map(|(shots, instant)| judge(&plan, shots, instant)).collect();
    by_share(results, &judged);
    finished(results, &plan, &judged);
    if size == RASTER { strip::write(&plan, shots.last().ok_or("there are shots")?) } else { Ok(()) }
}

fn judge(plan: &Plan, shots: &Shots, instant: usize) -> Judged {
    let levels = plan.levels(shots, instant);
    let [middles, means] =
        [Truth::Middles, Truth::Means].map(|truth| shots.seen(&shots.complete(instant, truth)));
    let row = |share: usize| {
        WAYS.map(|(_, way)| {
            let (made, spent) = plan.made((shots, instant), &levels, way, share)?;
            Some((shots.judge(&shots.seen(&made), &middles), spent))
        })
    };
    let (last, _) = plan.refined(&levels, plan.schedule().tiles());
    let last = shots.seen(&last);
    Judged {
        volume: shots.volume,
        rows: (0..SHARES.len()).map(row).collect(),
        finished: [shots.judge(&last, &middles), shots.judge(&last, &means)],
        complete: shots.judge(&middles, &means),
    }
}

/// The mean of some errors.
fn mean(errors: impl Iterator<Item = Erred>) -> Erred {
    let (mut sum, mut count) = (Erred::default(), 0.0);
    for error in errors {
        (sum.rms, sum.flip, count) = (sum.rms + error.rms, sum.flip + error.flip, count + 1.0);
    }
    Erred { rms: sum.rms / count, flip: sum.flip / count }
}

fn cell(error: Erred) -> String {
    format!("{:.2} / {:.4}", 255.0 * error.rms, error.flip)
}

/// A row for each volume and share: RMS and FLIP of each way.
fn by_share(results: &mut Results, judged: &[Judged]) {
    results.line("RMS / FLIP against the complete picture; in brackets what was cast, where that is not what might be:");
    results.line("");
    results.line(format!("| volume | rays a pixel | {} |", WAYS.map(|way| way.0).join(" | ")));
    results.line(format!("| --- | ---: |{}", " ---: |".repeat(WAYS.len())));
    let mut volumes: Vec<&str> = judged.iter().map(|one| one.volume).collect();
    volumes.dedup();
    for volume in volumes.into_iter().map(Some).chain([None]) {
        for (share, &rays) in SHARES.iter().enumerate() {
            let cells = [0, 1, 2, 3].map(|way| {
                let of = judged.iter().filter(|one| volume.is_none_or(|volume| volume == one.volume));
                let rows: Option<Vec<(Erred, f64)>> = of.map(|one| one.rows[share][way]).collect();
                let Some(rows) = rows else { return "–".to_owned() };
                let spent = rows[0].1;
                let note = if spent < 0.985 * rays { format!(" ({spent:.3})") } else { String::new() };
                cell(mean(rows.iter().map(|row| row.0))) + &note
            });
            let name = volume.unwrap_or("*all stills*");
            results.line(format!("| {name} | {} | {} |", fraction(rays), cells.join(" | ")));
        }
    }
    results.line("");
}

fn fraction(share: f64) -> String {
    if share < 1.0 { format!("1/{}", (1.0 / share).round()) } else { share.to_string() }
}

/// What is shown in the end.
fn finished(results: &mut Results, plan: &Plan, judged: &[Judged]) {
    let schedule = plan.schedule();
    let finest = &schedule.levels()[schedule.levels().len() - 1];
    let pixels = f64::from(finest.samples().size()[0] * finest.samples().size()[1]);
    results.line("In the end:");
    results.line("");
    results.line(
        "| | rays a pixel, of the last level and in all | against one ray a pixel | against the mean of 25 |",
    );
    results.line("| --- | ---: | ---: | ---: |");
    let complete = cell(mean(judged.iter().map(|one| one.complete)));
    results.line(format!("| lattices | 1, 1 | 0, to the bit | {complete} |"));
    let errors = [0, 1].map(|truth| cell(mean(judged.iter().map(|one| one.finished[truth]))));
    results.line(format!(
        "| points | {:.2}, {:.2} | {} |",
        finest.samples().count() as f64 / pixels,
        schedule.rays(schedule.tiles()) as f64 / pixels,
        errors.join(" | "),
    ));
    results.line("");
}
