//! Point pairs from a TOML file.

use crate::FrontendError;
use display_config::text::{ListOf, brief_text, read_text, with_suggestion};
use glam::DVec3;
use serde::Deserialize;
use std::path::Path;
use tracking::PointPair;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
struct PairsFile {
    #[serde(default)]
    pair: Vec<PairTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
struct PairTable {
    name: Option<String>,
    tracker_m: ListOf<f64, 3>,
    display_m: ListOf<f64, 3>,
}

/// The pairs of a file, in its order; one without a name is called by its number, from 1.
///
/// # Errors
/// A file that cannot be read, or is not a list of pairs. What the numbers are is not checked.
pub fn read_pairs(path: &Path) -> Result<Vec<PointPair>, FrontendError> {
    let text =
        read_text(path).map_err(|source| FrontendError::ReadPairs { path: path.to_owned(), source })?;
    parse(&text).map_err(|(line, message)| FrontendError::Pairs { path: path.to_owned(), line, message })
}

/// The pairs of a text, or the line that is wrong and why.
fn parse(text: &str) -> Result<Vec<PointPair>, (usize, String)> {
    let file: PairsFile = toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start.min(text.len()));
        let line = 1 + text.as_bytes()[..start].iter().filter(|&&byte| byte == b'\n').count();
        (line, with_suggestion(error.message()))
    })?;
    let pair = |(at, table): (usize, PairTable)| PointPair {
        name: table.name.map_or_else(|| format!("pair {}", at + 1), |name| brief_text(&name).into_owned()),
        point_in_tracker: DVec3::from_array(table.tracker_m.0),
        point_in_display: DVec3::from_array(table.display_m.0),
    };
    Ok(file.pair.into_iter().enumerate().map(pair).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_keep_their_order_and_names() {
        let text = "[[pair]]\ntracker_m = [1, 2.5, -3]\ndisplay_m = [0, 0, 0]\n\
                    [[pair]]\nname = 'lower left'\ntracker_m = [1, 2, nan]\ndisplay_m = [0.1, 0, 0]\n";
        let pairs = parse(text).unwrap();
        let names: Vec<_> = pairs.iter().map(|pair| pair.name.as_str()).collect();
        assert_eq!(names, ["pair 1", "lower left"]);
        assert_eq!(pairs[0].point_in_tracker, DVec3::new(1.0, 2.5, -3.0));
        assert!(pairs[1].point_in_tracker.z.is_nan(), "the registration refuses it by its name");
        assert_eq!(parse(""), Ok(Vec::new()));
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        for (text, line, part) in [
            ("[[pair]]\ntracker_m = [1, 2]\ndisplay_m = [0, 0, 0]", 2, "a list of 3"),
            ("[[pair]]\ntracker = [1, 2, 3]\ndisplay_m = [0, 0, 0]", 2, "did you mean `tracker_m`"),
            ("\n[[pair]]\ntracker_m = [1, 2, 3]", 2, "missing field `display_m`"),
            ("[[pair]\n", 1, ""),
            ("[[pairs]]\n", 1, "did you mean `pair`"),
        ] {
            let (at, message) = parse(text).unwrap_err();
            assert!(at == line && message.contains(part), "{text}: line {at}: {message}");
        }
    }
}
