//! The errors of a store's levels as a small table.

use crate::adapter::LevelSummary;

/// A heading and a line per level, the finest first; nothing if there are no levels.
pub(super) fn level_table(levels: &[LevelSummary]) -> String {
    if levels.is_empty() {
        return String::new();
    }
    let row = |level: &LevelSummary| {
        format!("{:<8}{:>14.3e}{:>14.3e}\n", level.level, level.rms_error, level.max_error)
    };
    let head = format!("{:<8}{:>14}{:>14}\n", "level", "RMS error", "largest");
    format!("{head}{}", levels.iter().map(row).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let level = |level, rms_error| LevelSummary { level, rms_error, max_error: 12.5 };
        let table = level_table(&[level(0, 0.25), level(11, 123.0)]);
        let widths: Vec<_> = table.lines().map(|line| line.chars().count()).collect();
        assert_eq!(widths, [36, 36, 36], "{table}");
        assert!(table.contains("2.500e-1") && table.contains("1.230e2"));
        assert_eq!(level_table(&[]), "");
    }
}
