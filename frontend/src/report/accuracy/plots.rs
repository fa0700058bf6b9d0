//! The plots: seconds against each measure of error.

use super::{AccuracyReport, Comparison, Measure};
use crate::accuracy::{Family, Measured, filter_name, small};
use crate::report::plot::{Chart, Mark, Point, Series, Stroke};

/// Families that are varied alone: what the legend calls them, and how they look.
const ALONE: [(Family, &str, Mark); 8] = [
    (Family::Termination, "other termination", Mark::Diamond),
    (Family::Levels, "other level tolerance", Mark::Triangle),
    (Family::Quadrilinear, "the same, quadrilinear", Mark::Triangle),
    (Family::Unblended, "the same, unblended", Mark::Diamond),
    (Family::Means, "the same, of means alone", Mark::Square),
    (Family::Bits, "fewer bits per voxel", Mark::Square),
    (Family::Filter, "other filter", Mark::Square),
    (Family::Scene, "the scene's own", Mark::Diamond),
];

/// A plot for each measure.
pub(super) fn plots(report: &AccuracyReport) -> Vec<String> {
    report.comparisons.iter().map(|comparison| plot(report, comparison).svg()).collect()
}

fn plot(report: &AccuracyReport, comparison: &Comparison) -> Chart {
    let measure = comparison.measure;
    let settings = &report.settings;
    let pick = |of: &dyn Fn(&Measured) -> bool| points(settings.iter().filter(|one| of(one)), measure);
    let front = points(comparison.front.iter().map(|&index| &settings[index]), measure);
    let mut series = vec![Series::new("Pareto front", front).stroke(Stroke::Wide)];
    series.extend(steps(settings, measure));
    series.extend(products(settings, measure));
    for (number, (family, name, mark)) in ALONE.into_iter().enumerate() {
        series.push(Series::new(name, pick(&|one| one.trial.family == family)).tone(number).mark(mark));
    }
    series.push(
        Series::new("the default", points(settings.iter().take(1), measure))
            .mark(Mark::Ring)
            .label("default"),
    );
    series.retain(|one| !one.points.is_empty());
    Chart {
        title: match measure {
            Measure::Rms => "RMS error".to_owned(),
            Measure::P999 => "99.9th percentile of the error".to_owned(),
            Measure::Max => "Largest error".to_owned(),
        },
        x_label: "seconds of the cast".to_owned(),
        y_label: "error of linear colour, units of 1/255".to_owned(),
        series,
    }
}

/// A line of step lengths for each tolerance.
fn steps(settings: &[Measured], measure: Measure) -> Vec<Series> {
    let of = |one: &&Measured| one.trial.family == Family::Steps;
    let mut tolerances: Vec<f64> =
        settings.iter().filter(of).map(|one| one.trial.setting.quality.tolerance).collect();
    tolerances.sort_by(|a, b| b.total_cmp(a));
    tolerances.dedup();
    let line = |(place, &tolerance): (usize, &f64)| {
        let mut row: Vec<&Measured> = settings
            .iter()
            .filter(of)
            .filter(|one| one.trial.setting.quality.tolerance == tolerance)
            .collect();
        let step = |one: &Measured| one.trial.setting.quality.step_voxels;
        row.sort_by(|a, b| step(b).total_cmp(&step(a)));
        let name = match tolerance.is_infinite() {
            true => "steps of one length".to_owned(),
            false => format!("steps, tolerance {}", small(tolerance)),
        };
        Series::new(name, points(row.into_iter(), measure))
            .ramp(place, tolerances.len())
            .mark(Mark::Dot)
            .stroke(Stroke::Thin)
    };
    tolerances.iter().enumerate().map(line).collect()
}

/// Dots for each filter and depth of samples of the whole product.
fn products(settings: &[Measured], measure: Measure) -> Vec<Series> {
    let of = |one: &&Measured| one.trial.family == Family::Product;
    let kind = |one: &Measured| (filter_name(one.trial.setting.filter), one.trial.setting.bits);
    let mut kinds: Vec<_> = settings.iter().filter(of).map(kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let dots = |(number, &(filter, bits)): (usize, &(&str, u8))| {
        let those = settings.iter().filter(of).filter(|one| kind(one) == (filter, bits));
        Series::new(format!("{filter}, {bits} bits"), points(those, measure)).tone(number).mark(Mark::Dot)
    };
    kinds.iter().enumerate().map(dots).collect()
}

fn points<'a>(settings: impl Iterator<Item = &'a Measured>, measure: Measure) -> Vec<Point> {
    let point = |one: &Measured| Point {
        x: one.seconds,
        y: measure.of_255(&one.errors),
        title: one.trial.setting.to_string(),
    };
    settings.map(point).collect()
}
