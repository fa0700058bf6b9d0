//! Still pictures by each way, with few rays and with many.

use super::kernels::{ALL, FEW, Kernels};
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
/// Rays of each raster may go through the middles of so many times as fine ones.
const PARTS: u32 = 5;
const PARTS_OF_LARGE: u32 = 3;
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
    let shots = Shots::of_all(&display, RASTER, PARTS, 3)?;
    heading(&mut results, &shots, RASTER, &patterns.small);
    let kernels =
        Kernels::best(&mut results, &shots, RASTER, ALL, &levels(&patterns, (&patterns.small, 4), 0));
    let grid = [0, 1, 2, 3].map(|depth| (&patterns.jittered, depth));
    results.line("And for one ray in each cell of a grid:");
    results.line("");
    let jittered = Kernels::best(&mut results, &shots, RASTER, ALL, &grid);
    let tuned = (&kernels, Some(&jittered));
    let plan = Plan::new((RASTER, PARTS), (&patterns.small, 4), 0, &patterns, tuned);
    tables(&mut results, &plan, &shots);
    strip::write(&plan, &shots[shots.len() - 1])?;
    drop(shots);
    let shots = Shots::of_all(&display, LARGE, PARTS_OF_LARGE, 1)?;
    heading(&mut results, &shots, LARGE, &patterns.full);
    let kernels = Kernels::best(&mut results, &shots, LARGE, FEW, &levels(&patterns, (&patterns.full, 3), 2));
    let plan = Plan::new((LARGE, PARTS_OF_LARGE), (&patterns.full, 3), 2, &patterns, (&kernels, None));
    tables(&mut results, &plan, &shots);
    results.finish()
}

fn heading(results: &mut Results, shots: &[Shots], size: [u32; 2], pattern: &Pattern) {
    let stills: usize = shots.iter().map(Shots::count).sum();
    let apart = shots.iter().map(Shots::apart).fold(0.0, f64::max);
    results.line(format!(
        "**{} × {} pixels**, {stills} stills; rays through a raster {} times as fine along each axis, levels of {} sites. \
         Drawn on its own raster, no still differs from the same rays of the finer one by an RMS above {:.3}. The best \
         Gaussians:",
        size[0],
        size[1],
        shots[0].parts(),
        pattern.places().len(),
        255.0 * apart,
    ));
    results.line("");
}

/// Levels that Gaussians are sought for; the even patterns have to be so much deeper.
fn levels<'a>(patterns: &'a Patterns, finest: (&'a Pattern, u32), deeper: u32) -> Vec<(&'a Pattern, u32)> {
    let even = EVEN_DEPTHS.map(|(which, depth)| (&patterns.even[which], depth + deeper));
    even.into_iter().chain([finest]).collect()
}

fn tables(results: &mut Results, plan: &Plan, shots: &[Shots]) {
    let all = shots.iter().flat_map(|shots| (0..shots.count()).map(move |instant| (shots, instant)));
    let judged: Vec<Judged> = all.map(|(shots, instant)| judge(plan, shots, instant)).collect();
    by_share(results, &judged);
    finished(results, plan, &judged, shots[0].parts());
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
fn finished(results: &mut Results, plan: &Plan, judged: &[Judged], parts: u32) {
    let schedule = plan.schedule();
    let finest = &schedule.levels()[schedule.levels().len() - 1];
    let pixels = f64::from(finest.samples().size()[0] * finest.samples().size()[1]);
    results.line("In the end:");
    results.line("");
    results.line(format!(
        "| | rays a pixel, of the last level and in all | against one ray a pixel | against the mean of {} |",
        parts * parts
    ));
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
