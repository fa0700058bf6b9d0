//! Curves of a study: how bad each value of a number is, and what idling saves.

use super::Stage;
use super::study::PlayedStage;
use crate::report::plot::{Chart, Mark, Point, Series, Stroke};

/// Where a 0 stands on a logarithmic axis, as a part of the least value above it.
const ZERO: f64 = 0.3;
/// Badness below this is drawn as this.
const LEAST: f64 = 1e-4;

/// How bad the settings of a stage are, as an `<svg>` element.
pub(super) fn badness_chart(played: &PlayedStage) -> String {
    let zero =
        ZERO * played.settings.iter().filter_map(|one| one.value).filter(|v| *v > 0.0).fold(1.0, f64::min);
    let curve = |(number, name): (usize, &str)| {
        let points = played.settings.iter().zip(&played.badness[number]).filter_map(|(setting, &badness)| {
            let value = setting.value?;
            let title = format!("{}: {badness:.4}", setting.name);
            Some(Point { x: value.max(zero), y: badness.max(LEAST), title })
        });
        Series::new(name, points.collect()).tone(number).mark(Mark::Dot).stroke(Stroke::Thin)
    };
    let mut series: Vec<Series> = ["by RMS", "by flicker"].into_iter().enumerate().map(curve).collect();
    // Those without a number are lines across.
    let ends = played
        .settings
        .iter()
        .filter_map(|one| one.value)
        .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value.max(zero)), high.max(value)));
    for (place, setting) in played.settings.iter().enumerate().filter(|(_, setting)| setting.value.is_none())
    {
        let badness = played.badness[0][place];
        let point =
            |x: f64| Point { x, y: badness.max(LEAST), title: format!("{}: {badness:.4}", setting.name) };
        let line = Series::new(format!("{}, by RMS", setting.name), vec![point(ends.0), point(ends.1)]);
        series.push(line.tone(2 + series.len()).mark(Mark::None).stroke(Stroke::Dashed));
    }
    Chart {
        title: format!("How bad a setting is over all scenarios, by {}", letter(played.stage)),
        x_label: format!("{} (0 at the left end)", letter(played.stage)),
        y_label: "sum of squares of how much more it errs than the best".to_owned(),
        series,
    }
    .svg()
}

/// Error against work by χ, as an `<svg>` element.
pub(super) fn work_chart(played: &PlayedStage) -> String {
    let runs = played.runs.first().map_or(1, Vec::len).max(1) as f64;
    let points = played.settings.iter().enumerate().map(|(place, setting)| {
        let rms = played.runs[place].iter().map(|run| run.score.rms).sum::<f64>() / runs;
        let busy = played.busy(place).as_secs_f64();
        Point {
            x: busy.max(1e-3),
            y: 255.0 * rms,
            title: format!("{}: {busy:.1} s, {:.3}/255", setting.name, 255.0 * rms),
        }
    });
    Chart {
        title: "What idling saves and costs".to_owned(),
        x_label: "seconds in which rays are cast, all runs".to_owned(),
        y_label: "mean RMS, 1/255".to_owned(),
        series: vec![
            Series::new("χ from 0 (right) up", points.collect()).tone(3).mark(Mark::Dot).stroke(Stroke::Thin),
        ],
    }
    .svg()
}

/// The letter of the number that a stage varies.
pub(super) fn letter(stage: Stage) -> &'static str {
    match stage {
        Stage::Rho => "ρ",
        Stage::Theta => "ϑ",
        Stage::Chi => "χ",
    }
}
