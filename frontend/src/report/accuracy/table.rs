//! The settings and what they cost and miss, row by row.

use super::{AccuracyReport, Measure};
use crate::accuracy::{Family, Measured, filter_name, levels_of, small};

/// The headings; errors are in units of 1/255.
pub(super) const HEADS: [&str; 12] = [
    "",
    "step",
    "tolerance",
    "ends at",
    "levels",
    "filter",
    "bits",
    "seconds",
    "samples/ray",
    "RMS",
    "99.9 %",
    "max",
];

/// A row for each setting, in their order; an error on its front is marked with a star.
pub(super) fn rows(report: &AccuracyReport) -> Vec<Vec<String>> {
    report.settings.iter().enumerate().map(|(index, one)| row(report, index, one)).collect()
}

fn row(report: &AccuracyReport, index: usize, one: &Measured) -> Vec<String> {
    let setting = &one.trial.setting;
    let quality = &setting.quality;
    let errors = report.comparisons.iter().map(|comparison| {
        let star = if comparison.front.contains(&index) { "*" } else { " " };
        format!("{}{star}", digits(comparison.measure.of_255(&one.errors)))
    });
    let what = [
        if index == 0 { "default" } else { family_name(one.trial.family) }.to_owned(),
        quality.step_voxels.to_string(),
        small(quality.tolerance),
        small(quality.termination),
        levels_of(quality),
        filter_name(setting.filter).to_owned(),
        setting.bits.to_string(),
        digits(one.seconds),
        format!("{:.1}", one.samples_per_ray),
    ];
    what.into_iter().chain(errors).collect()
}

/// What people call the reason of a trial.
pub(super) fn family_name(family: Family) -> &'static str {
    match family {
        Family::Steps => "steps",
        Family::Filter => "filter",
        Family::Bits => "bits",
        Family::Termination => "termination",
        Family::Levels => "levels",
        Family::Quadrilinear => "quadrilinear",
        Family::Unblended => "unblended",
        Family::Means => "means",
        Family::Scene => "scene's own",
        Family::Product => "product",
    }
}

/// Three significant digits.
pub(super) fn digits(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return number.to_string();
    }
    let decimals = (2 - number.abs().log10().floor() as i32).clamp(0, 7) as usize;
    format!("{number:.decimals$}")
}

/// The whole table for a terminal, with what its stars and the seconds mean, and where the default lies.
pub fn terminal_table(report: &AccuracyReport) -> String {
    let all: Vec<Vec<String>> =
        std::iter::once(HEADS.map(str::to_owned).to_vec()).chain(rows(report)).collect();
    let width = |column: usize| all.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..HEADS.len()).map(width).collect();
    let line = |row: &Vec<String>| {
        let cell = |(column, text): (usize, &String)| match column {
            0 => format!("{text:<0$}", widths[0]),
            _ => format!("  {text:>0$}", widths[column]),
        };
        let cells: String = row.iter().enumerate().map(cell).collect();
        format!("{}\n", cells.trim_end())
    };
    let table: String = all.iter().map(line).collect();
    let names = Measure::ALL.map(Measure::name).join(", ");
    let verdicts: String = report.verdicts().iter().map(|verdict| format!("{verdict}\n")).collect();
    format!("{table}Errors {names} of 255; * no setting is faster and more exact.\n{verdicts}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_count() {
        let numbers = [0.0, 0.012_34, 1.234, 123.4, 1234.0, 1.234e-9, f64::NAN].map(digits);
        assert_eq!(numbers, ["0", "0.0123", "1.23", "123", "1234", "0.0000000", "NaN"]);
    }
}
