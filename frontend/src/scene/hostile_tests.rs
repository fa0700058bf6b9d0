//! Scenes that somebody spoiled: each is a scene, or is refused in one sentence.

use super::tests::{FACTS, display, read};
use proptest::prelude::*;
use std::ops::Range;

const EXAMPLES: [&str; 3] = [
    include_str!("../../scenes/shells.toml"),
    include_str!("../../scenes/cranium.toml"),
    include_str!("../../scenes/illustration.toml"),
];

/// What may stand where a number should.
const WRONG: [&str; 20] = [
    "nan",
    "inf",
    "-inf",
    "-0.0",
    "0",
    "-1",
    "0.5",
    "65536",
    "4294967296",
    "9223372036854775807",
    "1e38",
    "1e308",
    "-1e308",
    "1e-320",
    "''",
    "\"\\u001b[31m\"",
    "[]",
    "[[0, 0], [0, 0]]",
    "{}",
    "true",
];

/// Where the text has numbers.
fn numbers(text: &str) -> Vec<Range<usize>> {
    let is_part = |c: char| c.is_ascii_digit() || ".+-e".contains(c);
    let mut found = Vec::new();
    let mut rest = 0;
    while let Some(at) = text[rest..].find(|c: char| c.is_ascii_digit()) {
        let from = rest + at;
        let length = text[from..].find(|c| !is_part(c)).unwrap_or(text.len() - from);
        found.push(from..from + length);
        rest = from + length;
    }
    found
}

/// A number replaced, one too many, or a line or a letter changed: all by the seed.
fn spoilt(text: &str, seed: u64) -> String {
    let pick = |count: usize, shift: u32| (seed >> shift) as usize % count.max(1);
    let mut lines: Vec<&str> = text.lines().collect();
    let (a, b) = (pick(lines.len(), 8), pick(lines.len(), 24));
    let numbers = numbers(text);
    let wrong = WRONG[pick(WRONG.len(), 40)];
    match (pick(8, 0), numbers.get(pick(numbers.len(), 8))) {
        (0..4, Some(at)) => format!("{}{wrong}{}", &text[..at.start], &text[at.end..]),
        (4, Some(at)) => format!("{}, {wrong}{}", &text[..at.end], &text[at.end..]),
        (5, _) if !lines.is_empty() => {
            lines.swap(a, b);
            lines.join("\n")
        }
        (6, _) if !lines.is_empty() => {
            let line = lines[a];
            lines.insert(b, line);
            lines.join("\n")
        }
        (5..7, _) => wrong.to_owned(),
        _ => {
            let mut letters: Vec<char> = text.chars().collect();
            let at = pick(letters.len(), 8);
            let by = char::from(pick(128, 24) as u8);
            match letters.get_mut(at) {
                Some(letter) if pick(2, 40) == 0 => *letter = by,
                _ => letters.insert(at, by),
            }
            letters.into_iter().collect()
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases.max(4000)))]
    #[test]
    fn a_spoiled_scene_is_refused_in_a_sentence(
        example in 0..EXAMPLES.len(), seeds in prop::collection::vec(any::<u64>(), 1..5),
    ) {
        let text = seeds.iter().fold(EXAMPLES[example].to_owned(), |text, &seed| spoilt(&text, seed));
        let is_sentence = |said: String| !said.is_empty() && !said.contains(['\n', '\u{1b}']);
        match read(&text) {
            Err(error) => prop_assert!(is_sentence(error.to_string()), "{error}"),
            Ok(scene) => for index in [0, scene.frame_count / 2, scene.frame_count - 1] {
                if let Err(error) = scene.frame(index, &display(), &FACTS) {
                    prop_assert!(is_sentence(error.to_string()), "{error}");
                }
            },
        }
    }
}
